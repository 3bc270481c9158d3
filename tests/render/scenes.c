#include "tests/render/scenes.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/mat.h"
#include "render/film/film.h"
#include "render/world/world.h"
#include "scene/scene.h"
#include "scene/transfer.h"

void must(bool ok, const kiln_report *report, const char *what) {
    if (ok) return;
    for (size_t i = 0; i < kiln_report_size(report); i++) {
        kiln_message m = kiln_report_message(report, i);
        print_error("%s: %s\n", m.where, m.what);
    }
    fail_msg("%s failed", what);
}

scene_builder builder_make(void) {
    scene_builder b = {kiln_scene_create(), kiln_report_create()};
    assert_non_null(b.scene);
    assert_non_null(b.report);
    return b;
}

void builder_free(scene_builder *b) {
    kiln_scene_destroy(b->scene);
    kiln_report_destroy(b->report);
}

kiln_material diffuse_material(float r, float g, float b) {
    kiln_material m = kiln_material_default();
    m.base_color.value[0] = r, m.base_color.value[1] = g, m.base_color.value[2] = b;
    m.metallic.value = 0;
    m.specular.value = 0;
    return m;
}

kiln_id add_material(scene_builder *b, const kiln_material *m) {
    kiln_id id;
    must(kiln_scene_add_material(b->scene, m, &id, b->report), b->report, "adding a material");
    return id;
}

kiln_id add_mesh(scene_builder *b, const kiln_mesh_desc *desc) {
    kiln_id id;
    must(kiln_scene_add_mesh(b->scene, desc, &id, b->report), b->report, "adding a mesh");
    return id;
}

void add_instance(scene_builder *b, kiln_id mesh, const double transform[16]) {
    kiln_instance_desc instance = {.mesh = mesh, .time_count = transform ? 1 : 0, .transforms = transform};
    must(kiln_scene_add_instance(b->scene, &instance, NULL, b->report), b->report, "adding an instance");
}

static void show(scene_builder *b, const kiln_mesh_desc *desc) { add_instance(b, add_mesh(b, desc), NULL); }

void add_quad(scene_builder *b, kiln_id material, const float corners[12]) {
    const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    const float uvs[8] = {0, 1, 1, 1, 1, 0, 0, 0};
    kiln_primvar uv = {.kind = KILN_PRIMVAR_UV, .values = uvs, .value_count = 4};
    show(b, &(kiln_mesh_desc){.name = "quad", .vertex_count = 4, .positions = corners, .face_count = 2,
                              .face_vertices = faces, .primvars = &uv, .primvar_count = 1, .material = material});
}

void add_sphere(scene_builder *b, kiln_id material, const float center[3], float radius, int segments, int flags) {
    bool inward = flags & SPHERE_INWARD;
    int rows = segments / 2, across = segments + 1;
    uint32_t vertices = (uint32_t)(across * (rows + 1)), count = 0;
    float *positions = calloc(3 * vertices, sizeof *positions), *normals = calloc(3 * vertices, sizeof *normals);
    uint32_t *faces = calloc((size_t)(6 * segments * rows), sizeof *faces);
    for (int j = 0; j <= rows; j++)
        for (int i = 0; i < across; i++) {
            double theta = M_PI * j / rows, phi = 2 * M_PI * (i % segments) / segments;
            double n[3] = {sin(theta) * cos(phi), cos(theta), -sin(theta) * sin(phi)};
            for (int k = 0; k < 3; k++) {
                positions[3 * (j * across + i) + k] = (float)(center[k] + radius * n[k]);
                normals[3 * (j * across + i) + k] = (float)(inward ? -n[k] : n[k]);
            }
        }
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < segments; i++) {
            uint32_t a = (uint32_t)(j * across + i), c = a + (uint32_t)across;
            uint32_t quad[6] = {a, c, a + 1, a + 1, c, c + 1};
            for (int t = j == 0; t < (j == rows - 1 ? 1 : 2); t++) /* poles have one triangle */
                for (int k = 0; k < 3; k++) faces[count++] = quad[3 * t + (inward && k ? 3 - k : k)];
        }
    kiln_primvar normal = {.kind = KILN_PRIMVAR_NORMAL, .values = normals, .value_count = vertices};
    show(b, &(kiln_mesh_desc){.name = "sphere", .vertex_count = vertices, .positions = positions,
                              .face_count = count / 3, .face_vertices = faces, .primvars = &normal,
                              .primvar_count = flags & SPHERE_FLAT ? 0 : 1, .material = material});
    free(positions);
    free(normals);
    free(faces);
}

void add_box(scene_builder *b, kiln_id material, const float low[3], const float high[3]) {
    float p[24];
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++) p[3 * i + k] = i >> k & 1 ? high[k] : low[k];
    const uint32_t sizes[6] = {4, 4, 4, 4, 4, 4};
    const uint32_t faces[24] = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
    show(b, &(kiln_mesh_desc){.name = "box", .vertex_count = 8, .positions = p, .face_count = 6,
                              .face_sizes = sizes, .face_vertices = faces, .material = material});
}

static void look(double m[16], const float eye[3], const float at[3]) {
    dvec3 e = {(double)eye[0], (double)eye[1], (double)eye[2]}, a = {(double)at[0], (double)at[1], (double)at[2]};
    dvec3 z = d3_normalize(d3_sub(e, a)), up = fabs(z.y) < 0.99 ? (dvec3){0, 1, 0} : (dvec3){1, 0, 0};
    dvec3 x = d3_normalize(d3_cross(up, z)), y = d3_cross(z, x);
    const double matrix[16] = {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, e.x, e.y, e.z, 1};
    memcpy(m, matrix, sizeof matrix);
}

void add_light(scene_builder *b, const kiln_light *l) {
    must(kiln_scene_add_light(b->scene, l, NULL, b->report), b->report, "adding a light");
}

kiln_light light_at(kiln_light_kind kind, const float position[3], const float at[3], float intensity) {
    kiln_light l = kiln_light_default();
    l.kind = kind;
    l.intensity = intensity;
    look(l.transform, position, at);
    return l;
}

kiln_id add_image(scene_builder *b, const float *rgb, uint32_t width, uint32_t height) {
    kiln_id id;
    kiln_image_desc desc = {.name = "image", .pixels = rgb, .width = width, .height = height, .channels = 3,
                            .format = KILN_PIXELS_F32};
    must(kiln_scene_add_image(b->scene, &desc, &id, b->report), b->report, "adding an image");
    return id;
}

void set_environment(scene_builder *b, kiln_id image, float r, float g, float bl) {
    kiln_environment e = {.image = image, .transfer = KILN_TRANSFER_LINEAR, .color = {r, g, bl}};
    must(kiln_scene_set_environment(b->scene, &e, b->report), b->report, "setting the environment");
}

kiln_camera camera_at(const float eye[3], const float at[3], double yfov_degrees) {
    kiln_camera camera = kiln_camera_default();
    camera.yfov_rad = yfov_degrees * M_PI / 180;
    look(camera.transform, eye, at);
    return camera;
}

/* Standard error of the mean over the picture. Pixels are independent; their channels, which share paths, are taken to
 * err together. */
static double error_of_mean(const kiln_film *f) {
    double variance = 0, m[3], v[3];
    size_t pixels = (size_t)f->width * f->height;
    for (size_t i = 0; i < pixels; i++) {
        film_read_pixel(f, i, m, v);
        double deviation = (sqrt(v[0]) + sqrt(v[1]) + sqrt(v[2])) / 3;
        variance += deviation * deviation;
    }
    return sqrt(variance) / (double)pixels;
}

picture render_with(const kiln_renderer *renderer, const kiln_render_options *options, const kiln_film_desc *desc,
                    kiln_report *report) {
    picture p = {0};
    must(kiln_film_create(desc, &p.film, report), report, "making a film");
    p.width = p.film->width;
    p.height = p.film->height;
    must(kiln_render(renderer, options, p.film, &p.stats, report), report, "rendering");
    p.rgb = calloc(3 * (size_t)p.width * p.height, sizeof *p.rgb);
    kiln_film_beauty(p.film, p.rgb);
    for (size_t i = 0; i < 3 * (size_t)p.width * p.height; i++) p.mean += (double)p.rgb[i];
    p.mean /= 3 * (double)p.width * p.height;
    p.mean_error = error_of_mean(p.film);
    p.error = kiln_film_estimate_error(p.film, 1);
    return p;
}

static void commit(scene_builder *b) {
    if (!b->scene->committed) must(kiln_scene_commit(b->scene, b->report), b->report, "committing");
}

world *build_world(scene_builder *b) {
    kiln_decoding decoding;
    transfer_rec709(&decoding);
    world *w;
    commit(b);
    must(world_create(b->scene, &(world_build_options){&decoding, KILN_TEXTURES_MIP, .threads = 1}, &w, b->report), b->report, "building the world");
    return w;
}

picture render(scene_builder *b, const kiln_camera *camera, const kiln_render_options *options, uint32_t width,
               uint32_t height) {
    commit(b);
    kiln_renderer *renderer;
    must(kiln_renderer_create(b->scene, &(kiln_renderer_options){.threads = 2}, &renderer, b->report), b->report,
         "making a renderer");
    kiln_render_options o = *options;
    if (camera) o.camera = camera;
    picture p = render_with(renderer, &o, &(kiln_film_desc){.width = width, .height = height}, b->report);
    kiln_renderer_destroy(renderer);
    return p;
}

void picture_free(picture *p) {
    kiln_film_destroy(p->film);
    free(p->rgb);
    *p = (picture){0};
}
