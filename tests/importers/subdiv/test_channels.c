/* Face-varying values: where they hang together, and what refinement makes of them. */
#include "tests/importers/subdiv/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "importers/subdiv/osd.h"
#include "kiln/import.h"

static kiln_cage build(fixture *f, const shape *s) {
    kiln_cage cage;
    char obstacle[160];
    kiln_id id = shape_add(f->scene, s, f->report);
    assert_true(cage_build(scene_mesh(f->scene, id), &(cage_options){0}, &f->arena, &cage, obstacle, NULL, f->report));
    return cage;
}

static const kiln_mesh *refine(fixture *f, const shape *s, kiln_subdivide_options options) {
    kiln_id id = shape_add(f->scene, s, f->report);
    options.threads = 1;
    assert_true(kiln_subdivide(f->scene, &options, NULL, NULL, f->report));
    return scene_mesh(f->scene, id);
}

/* A strip of four quads has 10 points; a seam in the middle doubles the values of two of them. The same strip, as an
 * exporter splits and cuts it, gives the same channel. */
static void seams_split_values_and_nothing_else_does(void **state) {
    fixture *f = *state;
    for (uint32_t seam = 1; seam <= 4; seam += 3) {
        shape strip, exported;
        shape_strip(&strip, 4, seam);
        shape_export(&exported, &strip);
        assert_int_equal(exported.desc.vertex_count, seam == 4 ? 10 : 12);
        const shape *both[2] = {&strip, &exported};
        for (int k = 0; k < 2; k++) {
            kiln_cage cage = build(f, both[k]);
            assert_int_equal(cage.vertex_count, 10);
            assert_int_equal(cage.face_count, 4);
            assert_int_equal(cage.channel_count, 1);
            assert_int_equal(cage.channels[0].value_count, seam == 4 ? 10 : 12);
        }
        shape_free(&strip);
        shape_free(&exported);
    }
}

/* Where the mesh has indices, they say what is one value: equal numbers at another index are a seam. */
static void indices_decide_where_there_are_any(void **state) {
    fixture *f = *state;
    shape strip;
    shape_strip(&strip, 2, 2);
    const uint32_t own[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    strip.primvars[0].indices = own;
    assert_int_equal(build(f, &strip).channels[0].value_count, 8);
    const uint32_t shared[8] = {0, 1, 2, 3, 1, 5, 6, 2};
    strip.primvars[0].indices = shared;
    assert_int_equal(build(f, &strip).channels[0].value_count, 6);
    /* An index that is used at two points stands for two values: OpenSubdiv refines values with points. */
    const uint32_t constant[8] = {0};
    strip.primvars[0].indices = constant;
    assert_int_equal(build(f, &strip).channels[0].value_count, 6);
    shape_free(&strip);
}

/* The UVs of a mesh that was never meant as a cage stay where the file has them, at every level and on both sides of
 * the seam. */
static void exported_uvs_stay_at_the_corners(void **state) {
    fixture *f = *state;
    for (uint32_t level = 1; level <= 3; level++) {
        shape sphere, exported;
        shape_quad_sphere(&sphere, 3, 1);
        shape_export(&exported, &sphere);
        kiln_cage cage = build(f, &exported);
        osd_surface s;
        assert_true(osd_refine(&cage, level, &f->arena, &s, NULL, f->report));
        const kiln_primvar *uv = &exported.primvars[1];
        for (uint32_t c = 0; c < cage.corner_count; c++) {
            const float *file = uv->values + 2 * exported.desc.face_vertices[cage.corner_sources[c]];
            const float *here = s.channels[0].values + 2 * s.channels[0].indices[s.cage_corners[c]];
            assert_true(file[0] == here[0] && file[1] == here[1]);
        }
        shape_free(&sphere);
        shape_free(&exported);
    }
}

/* On a flat strip of unit quads u is x / n, so it must be so at every refined corner: the limit of a linear function
 * is the function. The seam keeps both sides apart: nothing lies between u and u + 10. */
static void refined_uvs_are_linear_where_the_cage_is(void **state) {
    fixture *f = *state;
    shape strip, exported;
    shape_strip(&strip, 4, 1);
    shape_export(&exported, &strip);
    const kiln_mesh *m = refine(f, &exported, (kiln_subdivide_options){.mode = KILN_SUBDIVIDE_LEVEL, .level = 3});
    const kiln_primvar *uv = mesh_primvar(m, KILN_PRIMVAR_UV, 0);
    assert_int_equal(m->face_count, 4 * 64);
    bool seen[2] = {false, false};
    for (uint32_t c = 0; c < m->corner_count; c++) {
        const float *value = primvar_at(uv, c / 4, c, m->face_vertices[c]);
        bool behind = value[0] >= 10;
        float x = 0;
        for (uint32_t k = 0; k < 4; k++) x += m->positions[3 * m->face_vertices[c / 4 * 4 + k]] / 4; /* of the face */
        assert_true(behind == (x > 2));
        assert_true(value[0] <= 0.5f + 1e-6f || value[0] >= 10.5f - 1e-5f);
        seen[behind] = true;
    }
    assert_true(seen[0] && seen[1]);
    shape_free(&strip);
    shape_free(&exported);
}

static void every_kind_of_primvar_arrives(void **state) {
    fixture *f = *state;
    shape cube;
    shape_cube(&cube);
    float colors[32];
    for (int i = 0; i < 32; i++) colors[i] = (float)(i % 7) / 7;
    const float uv[2] = {.5f, .75f};
    float per_face[12];
    for (int i = 0; i < 12; i++) per_face[i] = (float)(i / 2);
    const float tangent[4] = {1, 0, 0, 1};
    const kiln_primvar primvars[4] = {{KILN_PRIMVAR_COLOR, 0, KILN_VERTEX, colors, 8, NULL},
                                      {KILN_PRIMVAR_UV, 0, KILN_CONSTANT, uv, 1, NULL},
                                      {KILN_PRIMVAR_UV, 1, KILN_UNIFORM, per_face, 6, NULL},
                                      {KILN_PRIMVAR_TANGENT, 0, KILN_CONSTANT, tangent, 1, NULL}};
    cube.desc.primvars = primvars;
    cube.desc.primvar_count = 4;
    kiln_material material = kiln_material_default();
    for (int i = 0; i < 3; i++) assert_true(kiln_scene_add_material(f->scene, &material, NULL, f->report));
    const kiln_id materials[6] = {1, 2, 3, 1, 2, 3};
    cube.desc.face_materials = materials;
    const kiln_mesh *m = refine(f, &cube, (kiln_subdivide_options){.mode = KILN_SUBDIVIDE_LEVEL, .level = 2});
    const kiln_primvar *color = mesh_primvar(m, KILN_PRIMVAR_COLOR, 0);
    assert_int_equal(color->interpolation, KILN_VERTEX); /* refined as positions are */
    assert_int_equal(color->value_count, m->vertex_count);
    assert_true(mesh_primvar(m, KILN_PRIMVAR_UV, 0)->interpolation == KILN_CONSTANT);
    assert_null(mesh_primvar(m, KILN_PRIMVAR_TANGENT, 0));
    assert_non_null(mesh_primvar(m, KILN_PRIMVAR_NORMAL, 0));
    for (uint32_t face = 0; face < m->face_count; face++) { /* children stay behind their parents, in order */
        assert_true(primvar_at(mesh_primvar(m, KILN_PRIMVAR_UV, 1), face, 0, 0)[0] == (float)(face / 16));
        assert_int_equal(mesh_face_material(m, face), materials[face / 16]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(seams_split_values_and_nothing_else_does, setup, teardown),
        cmocka_unit_test_setup_teardown(indices_decide_where_there_are_any, setup, teardown),
        cmocka_unit_test_setup_teardown(exported_uvs_stay_at_the_corners, setup, teardown),
        cmocka_unit_test_setup_teardown(refined_uvs_are_linear_where_the_cage_is, setup, teardown),
        cmocka_unit_test_setup_teardown(every_kind_of_primvar_arrives, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
