#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "base/hash.h"
#include "tests/render/scenes.h"

/* Codes that vary from texel to texel between low and high. */
static kiln_id noise_image(scene_builder *b, uint32_t seed, int low, int high) {
    uint8_t rgba[8 * 8 * 4];
    for (uint32_t i = 0; i < sizeof rgba; i++) rgba[i] = (uint8_t)(low + (int)(hash_pair(seed, i) % (uint32_t)(high - low + 1)));
    kiln_id id;
    kiln_image_desc desc = {.name = "noise", .pixels = rgba, .width = 8, .height = 8, .channels = 4};
    must(kiln_scene_add_image(b->scene, &desc, &id, b->report), b->report, "adding an image");
    return id;
}

static kiln_texture texture(kiln_id image, uint32_t channel, uint32_t uv_set, kiln_transfer transfer) {
    return (kiln_texture){.image = image, .channel = channel, .uv_set = uv_set, .transfer = transfer,
                          .wrap_u = uv_set ? KILN_WRAP_MIRROR : KILN_WRAP_REPEAT};
}

static kiln_id textured(scene_builder *b) {
    kiln_material m = kiln_material_default();
    m.base_color.texture = texture(noise_image(b, 1, 60, 250), 0, 0, KILN_TRANSFER_SRGB);
    m.metallic.texture = texture(noise_image(b, 2, 0, 255), 2, 0, KILN_TRANSFER_DATA);
    m.roughness.texture = texture(noise_image(b, 3, 0, 200), 1, 1, KILN_TRANSFER_DATA);
    m.normal.texture = texture(noise_image(b, 4, 100, 200), 0, 0, KILN_TRANSFER_DATA);
    m.specular.texture = texture(noise_image(b, 5, 0, 255), 3, 1, KILN_TRANSFER_DATA);
    m.specular_color.texture = texture(noise_image(b, 6, 128, 255), 0, 0, KILN_TRANSFER_SRGB);
    m.double_sided = true;
    return add_material(b, &m);
}

static kiln_id glass(scene_builder *b, float roughness, float thickness, float ior, float red) {
    kiln_material m = kiln_material_default();
    m.layers = KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME | KILN_LAYER_DISPERSION;
    m.dispersion = roughness;
    if (roughness > 0) m.layers |= KILN_LAYER_VOLUME_SCATTER;
    m.multiscatter_color[0] = 0.9f, m.multiscatter_color[1] = 0.6f;
    m.scatter_anisotropy = 0.4f;
    m.metallic.value = 0;
    m.roughness.value = roughness;
    m.transmission.value = 0.9f;
    m.transmission.texture = texture(noise_image(b, 7, 200, 255), 0, 0, KILN_TRANSFER_DATA);
    m.thickness.value = thickness;
    m.ior = ior;
    m.attenuation_distance = 0.3f;
    m.attenuation_color[0] = red;
    m.attenuation_color[1] = 0.5f;
    return add_material(b, &m);
}

static kiln_id coverage(scene_builder *b, kiln_alpha_mode mode) {
    kiln_material m = diffuse_material(0.2f, 0.7f, 0.3f);
    m.alpha_mode = mode;
    m.opacity.texture = texture(noise_image(b, 8, 0, 255), 3, 0, KILN_TRANSFER_DATA);
    m.opacity.value = 0.9f;
    m.double_sided = true;
    return add_material(b, &m);
}

/* Factors from 0 to 1 in one channel. */
static kiln_texture factors(scene_builder *b, uint32_t seed, uint32_t channel) {
    return texture(noise_image(b, seed, 0, 255), channel, seed % 2, KILN_TRANSFER_DATA);
}

static void add_clearcoat(scene_builder *b, kiln_material *m) {
    m->layers |= KILN_LAYER_CLEARCOAT;
    m->clearcoat.value = 0.9f;
    m->clearcoat.texture = factors(b, 20, 0);
    m->clearcoat_roughness.value = 0.5f;
    m->clearcoat_roughness.texture = factors(b, 21, 1);
    m->clearcoat_normal.texture = texture(noise_image(b, 22, 100, 160), 0, 0, KILN_TRANSFER_DATA);
}

static void add_sheen(scene_builder *b, kiln_material *m) {
    m->layers |= KILN_LAYER_SHEEN;
    for (int k = 0; k < 3; k++) m->sheen_color.value[k] = 0.3f + 0.3f * (float)k;
    m->sheen_color.texture = texture(noise_image(b, 23, 0, 255), 0, 0, KILN_TRANSFER_SRGB);
    m->sheen_roughness.value = 0.8f;
    m->sheen_roughness.texture = factors(b, 24, 3);
}

static void add_anisotropy(scene_builder *b, kiln_material *m) {
    m->layers |= KILN_LAYER_ANISOTROPY;
    m->anisotropy.value = 0.8f;
    m->anisotropy.texture = factors(b, 25, 0);
    m->anisotropy_rotation = 0.7f;
}

static void add_film(scene_builder *b, kiln_material *m) {
    m->layers |= KILN_LAYER_IRIDESCENCE;
    m->iridescence.value = 0.9f;
    m->iridescence.texture = factors(b, 26, 0);
    m->iridescence_ior = 1.4f;
    m->iridescence_thickness[0] = 100, m->iridescence_thickness[1] = 600;
    m->iridescence_thickness_texture = factors(b, 27, 1);
}

static void add_diffuse_transmission(scene_builder *b, kiln_material *m) {
    m->layers |= KILN_LAYER_DIFFUSE_TRANSMISSION;
    m->diffuse_transmission.value = 0.7f;
    m->diffuse_transmission.texture = factors(b, 28, 3);
    m->diffuse_transmission_color.value[0] = 0.4f;
    m->diffuse_transmission_color.texture = texture(noise_image(b, 29, 0, 255), 0, 0, KILN_TRANSFER_SRGB);
}

/* A dielectric with none, some or all of the layers on it. */
enum { COATED = 1, CLOTH = 2, BRUSHED = 4, OILY = 8, THIN_LEAF = 16, WAX = 32, GLOSSY = 64, ALL = 127 };

static kiln_id layered(scene_builder *b, int layers, float metallic) {
    kiln_material m = kiln_material_default();
    m.metallic.value = metallic;
    m.roughness.value = 0.6f;
    m.base_color.value[1] = 0.7f;
    m.double_sided = true;
    if (layers & COATED) add_clearcoat(b, &m);
    if (layers & CLOTH) add_sheen(b, &m);
    if (layers & BRUSHED) add_anisotropy(b, &m);
    if (layers & OILY) add_film(b, &m);
    if (layers & (THIN_LEAF | WAX)) add_diffuse_transmission(b, &m);
    if (layers & WAX) {
        m.layers |= KILN_LAYER_VOLUME;
        m.thickness.value = 1;
        m.attenuation_distance = 0.2f;
        m.attenuation_color[2] = 0.3f;
    }
    if (layers & GLOSSY) {
        m.layers |= KILN_LAYER_GLOSSINESS;
        m.roughness.texture = factors(b, 30, 3);
    }
    return add_material(b, &m);
}

static kiln_id emitter(scene_builder *b, bool unlit) {
    kiln_material m = diffuse_material(0.5f, 0.5f, 0.4f);
    for (int k = 0; k < 3; k++) m.emission.value[k] = 3;
    m.emission.texture = texture(noise_image(b, 9, 0, 255), 0, 0, KILN_TRANSFER_SRGB);
    if (unlit) m.layers = KILN_LAYER_UNLIT;
    else add_clearcoat(b, &m);
    return add_material(b, &m);
}

/* A panel with two UV sets, tangents and vertex colours, placed some times. */
static void add_panel(scene_builder *b, kiln_id material, const double (*transforms)[16], int copies) {
    const float p[12] = {-1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1}, n[12] = {0, 1, 0, .1f, 1, 0, 0, 1, .1f, 0, 1, 0};
    const float uv[8] = {0, 0, 2, 0, 2, 2, 0, 2}, uv1[8] = {0, 1, 1, 1, 1.5f, 0, 0, -.5f};
    const float t[16] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, .2f, 1, 1, 0, 0, 1};
    const float c[16] = {1, 1, 1, 1, .8f, 1, 1, 1, 1, .7f, 1, .9f, 1, 1, .6f, 1};
    const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    const kiln_primvar primvars[] = {{.kind = KILN_PRIMVAR_NORMAL, .values = n, .value_count = 4},
                                     {.kind = KILN_PRIMVAR_UV, .values = uv, .value_count = 4},
                                     {.kind = KILN_PRIMVAR_UV, .set = 1, .values = uv1, .value_count = 4},
                                     {.kind = KILN_PRIMVAR_TANGENT, .values = t, .value_count = 4},
                                     {.kind = KILN_PRIMVAR_COLOR, .values = c, .value_count = 4}};
    kiln_mesh_desc desc = {.name = "panel", .vertex_count = 4, .positions = p, .face_count = 2, .face_vertices = faces,
                           .primvars = primvars, .primvar_count = 5, .material = material};
    kiln_id mesh;
    must(kiln_scene_add_mesh(b->scene, &desc, &mesh, b->report), b->report, "adding a panel");
    for (int i = 0; i < copies; i++) {
        kiln_instance_desc instance = {.mesh = mesh, .time_count = 1, .transforms = transforms[i]};
        must(kiln_scene_add_instance(b->scene, &instance, NULL, b->report), b->report, "placing a panel");
    }
}

/* Side by side below the lamp; what is made of tangents has some, and solids are closed. */
static void add_layered(scene_builder *b) {
    static const int panels[] = {COATED, CLOTH, COATED | BRUSHED, OILY, THIN_LEAF | GLOSSY, BRUSHED | GLOSSY, ALL & ~WAX};
    for (int i = 0; i < 7; i++) {
        double x = -1.5 + 0.5 * i, z = 0.9 - 0.1 * (i % 3);
        const double at[1][16] = {{.22, 0, .04, 0, .03, .1, -.2, 0, 0, .2, .1, 0, x, .35 + .1 * (i % 2), z, 1}};
        add_panel(b, layered(b, panels[i], i % 3 == 2 ? 0.8f : 0.1f), at, 1);
    }
    add_sphere(b, layered(b, WAX, 0), (float[3]){-1, 1.2f, .5f}, .2f, 16, 0);
    add_sphere(b, layered(b, ALL & ~THIN_LEAF, 0.2f), (float[3]){1.1f, 1.2f, .5f}, .2f, 16, 0);
}

void add_everything(scene_builder *b) {
    const double floor_at[1][16] = {{3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1}};
    const double panels[3][16] = {{.4, .1, 0, 0, -.1, .4, 0, 0, 0, .2, .4, 0, -1, .4, -.5, 1},
                                  {-.5, 0, 0, 0, 0, .5, 0, 0, 0, 0, .5, 0, 1.2, 1, -.4, 1}, /* mirrored */
                                  {.3, .3, 0, 0, -.3, .3, 0, 0, 0, 0, .4, 0, 0, 1.6, -1, 1}};
    const double curtain[1][16] = {{.8, 0, 0, 0, 0, 0, .8, 0, 0, -.8, 0, 0, -.4, .8, 1.2, 1}};
    const double lamp[1][16] = {{.3, 0, 0, 0, 0, -.3, 0, 0, 0, 0, -.3, 0, 0, 2.6, 0, 1}};
    const double sign[1][16] = {{.3, 0, 0, 0, 0, 0, .3, 0, 0, -.3, 0, 0, 1.6, .5, -1, 1}};
    kiln_material floor = diffuse_material(0.6f, 0.5f, 0.4f), metal = kiln_material_default();
    kiln_id both = noise_image(b, 10, 60, 255); /* one look-up finds both */
    metal.roughness.value = 0.2f, metal.base_color.value[2] = 0.4f;
    metal.metallic.texture = texture(both, 2, 0, KILN_TRANSFER_DATA);
    metal.roughness.texture = texture(both, 1, 0, KILN_TRANSFER_DATA);
    kiln_material mirror = kiln_material_default();
    mirror.roughness.value = 0;
    kiln_material film = kiln_material_default();
    film.layers = KILN_LAYER_TRANSMISSION, film.transmission.value = 1, film.metallic.value = 0, film.roughness.value = 0.3f;
    add_panel(b, add_material(b, &floor), floor_at, 1);
    add_panel(b, textured(b), panels, 3);
    add_panel(b, coverage(b, KILN_ALPHA_BLEND), curtain, 1);
    add_panel(b, emitter(b, false), lamp, 1);
    add_panel(b, emitter(b, true), sign, 1);
    add_sphere(b, glass(b, 0, 1, 1.5f, 0.9f), (float[3]){0, .5f, 0}, .45f, 24, 0);
    add_sphere(b, glass(b, 0.2f, 1, 1.33f, 0.3f), (float[3]){0, .5f, 0}, .2f, 16, 0);
    add_sphere(b, add_material(b, &mirror), (float[3]){-.9f, .3f, .6f}, .3f, 24, 0);
    add_sphere(b, add_material(b, &metal), (float[3]){.9f, .3f, .6f}, .3f, 24, 0);
    add_sphere(b, add_material(b, &film), (float[3]){.4f, 1.3f, .4f}, .25f, 16, SPHERE_FLAT);
    add_sphere(b, coverage(b, KILN_ALPHA_MASK), (float[3]){-.5f, 1.3f, .2f}, .2f, 16, 0);
    add_layered(b);
    kiln_light point = light_at(KILN_LIGHT_POINT, (float[3]){-1.5f, 1.5f, 1}, (float[3]){0, 0, 0}, 2);
    kiln_light spot = light_at(KILN_LIGHT_SPOT, (float[3]){1.5f, 2, 1.5f}, (float[3]){0, .3f, 0}, 6);
    kiln_light beam = light_at(KILN_LIGHT_DISTANT, (float[3]){1, 3, 1}, (float[3]){0, 0, 0}, 0.5f);
    kiln_light sun = light_at(KILN_LIGHT_DISTANT, (float[3]){-2, 2, -3}, (float[3]){0, 0, 0}, 1);
    sun.angle_rad = 0.2f;
    add_light(b, &point), add_light(b, &spot), add_light(b, &beam), add_light(b, &sun);
    float sky[8 * 4 * 3];
    for (uint32_t i = 0; i < 96; i++) sky[i] = unit_float(hash_pair(77, i)) * (i == 20 ? 30.0f : 0.6f);
    set_environment(b, add_image(b, sky, 8, 4), 1, 1, 1);
}

kiln_camera everything_camera(void) {
    kiln_camera camera = camera_at((float[3]){0.3f, 1.3f, 3.6f}, (float[3]){0, 0.8f, 0}, 50);
    camera.lens_radius = 0.03;
    camera.focus_distance = 3.2;
    camera.blades = 5;
    return camera;
}
