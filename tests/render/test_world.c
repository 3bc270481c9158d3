/* The world that a renderer makes of a scene: copies of meshes, and what it says about what it leaves out. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/hash.h"
#include "scene/transfer.h"
#include "tests/render/rays.h"

/* 3,200 triangles: 400 copies are more than are written out (BAKE_TRIANGLES). */
enum { SIDE = 40, ACROSS = SIDE + 1, VERTICES = ACROSS * ACROSS, TRIANGLES = 2 * SIDE * SIDE, MANY = 400 };

/* A hilly square around the origin. Normals and tangents have all lengths, as they may. */
static kiln_id add_hills(scene_builder *b, kiln_id material) {
    static float positions[3 * VERTICES], normals[3 * VERTICES], tangents[4 * VERTICES], uvs[2 * VERTICES];
    static uint32_t faces[3 * TRIANGLES];
    for (int i = 0; i < VERTICES; i++) {
        double x = (double)(i % ACROSS) / SIDE - 0.5, z = (double)(i / ACROSS) / SIDE - 0.5;
        double length = 0.5 + i % 7, dx = 1.2 * cos(12 * x), dz = -0.8 * sin(8 * z);
        const double p[3] = {x, 0.1 * sin(12 * x) + 0.1 * cos(8 * z), z}, n[3] = {-dx, 1, -dz}, t[3] = {1, dx, 0};
        for (int k = 0; k < 3; k++) {
            positions[3 * i + k] = (float)p[k];
            normals[3 * i + k] = (float)(length * n[k]);
            tangents[4 * i + k] = (float)(length * t[k]);
        }
        tangents[4 * i + 3] = 1;
    }
    uint32_t *f = faces;
    for (uint32_t j = 0; j < SIDE; j++)
        for (uint32_t i = 0; i < SIDE; i++, f += 6) {
            uint32_t a = j * ACROSS + i, c = a + ACROSS;
            memcpy(f, (uint32_t[]){a, c, a + 1, a + 1, c, c + 1}, 6 * sizeof *f);
        }
    const kiln_primvar primvars[] = {{.kind = KILN_PRIMVAR_NORMAL, .values = normals, .value_count = VERTICES},
                                     {.kind = KILN_PRIMVAR_TANGENT, .values = tangents, .value_count = VERTICES},
                                     {.kind = KILN_PRIMVAR_UV, .values = uvs, .value_count = VERTICES}};
    return add_mesh(b, &(kiln_mesh_desc){.name = "hills", .vertex_count = VERTICES, .positions = positions,
                                         .face_count = TRIANGLES, .face_vertices = faces, .primvars = primvars,
                                         .primvar_count = 3, .material = material});
}

static void add_others(scene_builder *b, kiln_id mesh, int count) {
    for (int i = 0; i < count; i++)
        add_instance(b, mesh, (double[]){1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1.1 * (i % 20), 0, 1.1 * (i / 20), 1});
}

/* Scale 0 is how a node is hidden. A copy without an area is not there; a flat one is written out alone. */
static void a_flat_copy_leaves_the_others_shared(void **state) {
    (void)state;
    static const struct { double scale[3]; uint32_t triangles; } rows[] = {
        {{1, 1, 1}, 0}, {{0, 0, 0}, 0}, {{0, 2, 0}, 0}, {{2, 0, 2}, TRIANGLES}, {{1e-30, 1e-30, 1e-30}, TRIANGLES}};
    for (int i = 0; i < 5; i++) {
        scene_builder b = builder_make();
        kiln_id mesh = add_hills(&b, 0);
        add_others(&b, mesh, MANY);
        const double *s = rows[i].scale, turn = 0.3; /* in a turned parent, so that 0 is what rounding makes of it */
        double c = cos(turn), d = sin(turn);
        add_instance(&b, mesh,
                     (double[]){c * s[0], d * s[0], 0, 0, -d * s[1], c * s[1], 0, 0, 0, 0, s[2], 0, 3, 5, 3, 1});
        world *w = build_world(&b);
        assert_int_equal(w->instance_count, 1 + MANY + (i == 0));
        assert_int_equal(w->triangle_count, TRIANGLES + rows[i].triangles);
        rays r = rays_make(1);
        rays_set(&r, 0, to_float(world_point(w, (dvec3){3.01, 50, 3.02})), v3(0, -1, 0));
        rays_closest(w, &r, NULL, 1);
        bool above = fabs((double)r.t[0] / w->scale - 45) < 1; /* or else the copies at y = 0 */
        assert_true(above == (i == 0 || i == 3));
        rays_free(&r);
        world_destroy(w);
        builder_free(&b);
    }
}

/* In a parent that stretches, a turned child: shears and flips too. */
static const double placements[][16] = {
    {1, 0, 0, 0, 0, 0.2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
    {0.6, 0.8, 0, 0, -2.4, 1.8, 0, 0, 0, 0, 5, 0, 1, 2, 3, 1},
    {-1, 0.3, 0, 0, 0.5, 2, 0.1, 0, 0, 0.7, 0.4, 0, -3, 0, 1, 1},
    {1e-3, 0, 0, 0, 0, 1e-3, 0, 0, 0, 0, 2e-3, 0, 4, 1, 0, 1},
};
enum { PLACEMENTS = sizeof placements / sizeof *placements };

/* The hills under all placements, and so many other copies. */
static world *place_hills(scene_builder *b, int others) {
    *b = builder_make();
    kiln_material m = diffuse_material(1, 1, 1);
    m.normal.texture = (kiln_texture){.image = add_image(b, (float[]){0.6f, 0.5f, 1}, 1, 1)};
    kiln_id mesh = add_hills(b, add_material(b, &m));
    for (int i = 0; i < PLACEMENTS; i++) add_instance(b, mesh, placements[i]);
    add_others(b, mesh, others);
    return build_world(b);
}

/* Largest difference of directions at a vertex, and by how much the ratio of lengths varies: equal ratios are what
 * makes interpolated directions equal too. */
static double difference(vec3 a, vec3 b, double *ratio) {
    double la = (double)v3_length(a), lb = (double)v3_length(b), here = la / lb, first = *ratio > 0 ? *ratio : here;
    *ratio = first;
    return fmax((double)v3_length(v3_sub(v3_scale(a, (float)(1 / la)), v3_scale(b, (float)(1 / lb)))),
                fabs(here / first - 1));
}

static dvec3 in_scene(const world *w, vec3 p) {
    return d3_add(d3_scale((dvec3){(double)p.x, (double)p.y, (double)p.z}, 1 / w->scale), w->center);
}

/* Whether a mesh was written out or is placed by Embree must not be seen. */
static void written_and_placed_copies_are_alike(void **state) {
    (void)state;
    scene_builder few, many;
    world *written = place_hills(&few, 0), *placed = place_hills(&many, MANY);
    assert_int_equal(written->instance_count, 1);
    assert_int_equal(placed->instance_count, 1 + PLACEMENTS + MANY);
    for (uint32_t i = 0; i < PLACEMENTS; i++) {
        const world_instance *copy = &placed->instances[1 + i];
        double points = 0, normals = 0, tangents = 0, normal_ratio = 0, tangent_ratio = 0;
        for (uint32_t v = 0; v < VERTICES; v++) {
            uint32_t at = i * VERTICES + v;
            const world_vertex *a = &written->vertices[at], *b = &placed->vertices[v];
            dvec3 p = in_scene(written, v3_load(a->p)), q = in_scene(placed, world_instance_point(copy, v3_load(b->p)));
            vec3 n = world_instance_normal(copy, v3_load(b->n));
            points = fmax(points, d3_length(d3_sub(p, q)));
            normals = fmax(normals, difference(v3_load(a->n), n, &normal_ratio));
            const float *s = written->tangents + 4 * (size_t)at, *t = placed->tangents + 4 * (size_t)v;
            tangents = fmax(tangents, difference(v3_load(s), world_instance_vector(copy, v3_load(t)), &tangent_ratio));
            assert_true(s[3] == t[3] * copy->side);
        }
        if (points > 1e-5 || normals > 2e-6 || tangents > 2e-6)
            fail_msg("placement %u: points %g, normals %g, tangents %g", i, points, normals, tangents);
    }
    world_destroy(written);
    world_destroy(placed);
    builder_free(&few);
    builder_free(&many);
}

/* Motion is kept by the scene and not shown: that is said once, with a count. */
static void motion_is_warned_of(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_id still = add_hills(&b, 0);
    const float p[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0};
    kiln_mesh_desc flap = {.vertex_count = 3, .time_count = 2, .positions = p, .face_count = 1,
                           .face_vertices = (uint32_t[]){0, 1, 2}};
    kiln_id bending = add_mesh(&b, &flap);
    const double path[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 9, 0,
                             0, 1};
    kiln_instance_desc moving = {.mesh = still, .time_count = 2, .transforms = path};
    must(kiln_scene_add_instance(b.scene, &moving, NULL, b.report), b.report, "adding an instance");
    add_instance(&b, still, NULL);
    add_instance(&b, bending, NULL);
    world *w = build_world(&b);
    assert_int_equal(kiln_report_size(b.report), 1);
    kiln_message m = kiln_report_message(b.report, 0);
    assert_true(m.severity == KILN_WARNING && m.code == KILN_CODE_IGNORED && m.count == 1);
    assert_non_null(strstr(m.what, "2 of 3 instances"));
    double first = ((double)w->vertices[0].p[0] / w->scale + w->center.x) - (2 - 0.5);
    assert_true(fabs(first) < 1e-4);
    world_destroy(w);
    builder_free(&b);
}

/* Floats in a picture may be anything; what a material takes from them may not: more than all light reflected makes a
 * closed room blow up. Where a picture is emission too, that is not bounded by 1. */
static void float_textures_keep_to_their_domains(void **state) {
    (void)state;
    static const float unit[12] = {0.5f, 1, 0, 0, 0.25f, 0, 1, 0, 1, 1, 1, 1};
    for (int curved = 0; curved < 2; curved++) {
        float huge = curved ? 1e14f : 1e35f; /* the curve's power of it is a float yet */
        const float rgb[12] = {0.5f, 1.5f, -1, NAN, 0.25f, INFINITY, 1, 0, huge, 1, 1, 1};
        const float positive[12] = {0.5f, 1.5f, 0, 0, 0.25f, 0, 1, 0, fminf(huge, 1e30f), 1, 1, 1};
        scene_builder b = builder_make();
        kiln_material m = kiln_material_default();
        kiln_texture t = {.image = add_image(&b, rgb, 2, 2), .filter = KILN_FILTER_NEAREST,
                          .transfer = curved ? KILN_TRANSFER_SRGB : KILN_TRANSFER_LINEAR};
        m.base_color.texture = m.emission.texture = m.specular_color.texture = t;
        t.transfer = KILN_TRANSFER_DATA;
        m.metallic.texture = m.roughness.texture = m.specular.texture = m.opacity.texture = m.normal.texture = t;
        m.emission.value[0] = 1;
        m.alpha_mode = KILN_ALPHA_BLEND;
        add_instance(&b, add_hills(&b, add_material(&b, &m)), NULL);
        world *w = build_world(&b);
        const world_material *made = &w->materials[1];
        for (int slot = 0; slot < SLOT_COUNT; slot++) {
            if (!made->texture[slot]) continue;
            bool color = slot == SLOT_BASE || slot == SLOT_EMISSION || slot == SLOT_SPECULAR_COLOR;
            const float *domain = slot == SLOT_EMISSION || slot == SLOT_SPECULAR_COLOR ? positive : unit;
            for (int i = 0; i < 4; i++) {
                texel c = texture_sample(&w->textures[made->texture[slot] - 1], 0.25f + 0.5f * (float)(i & 1),
                                         0.25f + 0.5f * (float)(i >> 1));
                const float got[3] = {c.r, c.g, c.b};
                for (int k = 0; k < 3; k++) {
                    float code = domain[3 * i + k];
                    float wanted = color && curved ? fminf(transfer_decode(KILN_TRANSFER_SRGB, code), 1e30f) : code;
                    if (!(fabsf(got[k] - wanted) <= 1e-6f * wanted))
                        fail_msg("slot %d, texel %d[%d]: %g instead of %g", slot, i, k, (double)got[k], (double)wanted);
                }
            }
        }
        assert_int_equal(kiln_report_count(b.report, KILN_WARNING), curved ? 3 : 2); /* one for each way of reading it */
        assert_non_null(strstr(kiln_report_message(b.report, 0).what, "of 4 texels"));
        world_destroy(w);
        builder_free(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_copy_leaves_the_others_shared),
        cmocka_unit_test(written_and_placed_copies_are_alike),
        cmocka_unit_test(motion_is_warned_of),
        cmocka_unit_test(float_textures_keep_to_their_domains),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
