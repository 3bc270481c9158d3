/* Real glTF files: nothing cracks, UVs stay, and `auto` rounds off what is round. */
#include "tests/importers/subdiv/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "importers/gltf/gltf.h"
#include "importers/subdiv/edges.h"
#include "importers/subdiv/osd.h"
#include "tests/assets.h"

static void import(fixture *f, const char *root, const char *file) {
    char path[8192];
    snprintf(path, sizeof path, "%s/gltf/%s", root, file);
    assert_true(gltf_import(path, &(kiln_import_options){0}, f->scene, f->report));
}

static kiln_cage cage_of(fixture *f, kiln_id id) {
    kiln_cage cage;
    char obstacle[160];
    assert_true(cage_build(scene_mesh(f->scene, id), &(cage_options){0}, &f->arena, &cage, obstacle, NULL, f->report));
    return cage;
}

static uint32_t open_edges(fixture *f, const kiln_cage *c) {
    polygons p = {c->vertex_count, c->face_count, c->corner_count, c->face_sizes, c->face_vertices};
    edge_table table;
    uint32_t open = 0;
    assert_true(edges_build(&p, &f->arena, &table));
    for (uint32_t e = 0; e < table.count; e++) open += table.edges[e].uses == 1;
    return open;
}

/* Every edge that two faces shared before is shared after: a level halves the open edges, and opens no other. */
static void a_refined_helmet_has_no_crack(void **state) {
    fixture *f = *state;
    import(f, assets_or_skip(), "FlightHelmet/FlightHelmet.gltf");
    uint32_t count = f->scene->mesh_count, *open = calloc(count, sizeof *open);
    assert_true(count >= 6 && open);
    for (kiln_id id = 1; id <= count; id++) {
        kiln_cage cage = cage_of(f, id);
        open[id - 1] = open_edges(f, &cage);
        assert_int_equal(open[id - 1], shape_edges(scene_mesh(f->scene, id)).open);
    }
    kiln_subdivide_options options = {.mode = KILN_SUBDIVIDE_LEVEL, .level = 1};
    assert_true(kiln_subdivide(f->scene, &options, NULL, NULL, f->report));
    for (kiln_id id = 1; id <= count; id++)
        assert_int_equal(shape_edges(scene_mesh(f->scene, id)).open, 2 * open[id - 1]);
    assert_int_equal(kiln_report_count(f->report, KILN_ERROR), 0);
    free(open);
}

static void a_refined_helmet_keeps_its_uvs(void **state) {
    fixture *f = *state;
    import(f, assets_or_skip(), "FlightHelmet/FlightHelmet.gltf");
    for (kiln_id id = 1; id <= f->scene->mesh_count; id++) {
        const kiln_mesh *m = scene_mesh(f->scene, id);
        const kiln_primvar *uv = mesh_primvar(m, KILN_PRIMVAR_UV, 0);
        kiln_cage cage = cage_of(f, id);
        osd_surface s;
        assert_true(osd_refine(&cage, 1, &f->arena, &s, NULL, f->report));
        for (uint32_t c = 0; c < cage.corner_count; c++) {
            uint32_t source = cage.corner_sources[c];
            const float *file = primvar_at(uv, source / 3, source, m->face_vertices[source]);
            const float *here = s.channels[0].values + 2 * s.channels[0].indices[s.cage_corners[c]];
            assert_true(file[0] == here[0] && file[1] == here[1]);
        }
        arena_free(&f->arena);
    }
}

/* Expects exactly the meshes whose names stand in refined (NULL at the end) to be refined. */
static void look(fixture *f, const char *root, const char *file, const char *const *refined) {
    kiln_subdivision_result *rows;
    uint32_t count;
    import(f, root, file);
    assert_true(kiln_subdivide(f->scene, NULL, &rows, &count, f->report));
    for (uint32_t i = 0; i < count; i++) {
        const char *name = scene_mesh(f->scene, i + 1)->name;
        bool expected = false;
        for (const char *const *r = refined; *r; r++) expected |= !strcmp(*r, name);
        if (rows[i].refined != expected) fail_msg("%s: '%s': %s", file, name, rows[i].reason);
    }
    free(rows);
    kiln_scene_destroy(f->scene);
    f->scene = kiln_scene_create();
}

static void round_things_are_refined_and_others_are_not(void **state) {
    fixture *f = *state;
    const char *root = assets_or_skip();
    look(f, root, "FlightHelmet/FlightHelmet.gltf", (const char *[]){"Hose_low", NULL});
    look(f, root, "SunglassesKhronos.glb", (const char *[]){"LensesInterior", "LensesExterior", "Nosepads", NULL});
    look(f, root, "15_transmission/15_transmission.gltf",
         (const char *[]){"pbr", "transmissionFactor", "transmissionTexture", "transmissionFactorTexture",
                          "transmissionTextureNoFactor", NULL});
    look(f, root, "AlphaBlendModeTest.glb", (const char *[]){NULL});
    look(f, root, "CesiumMilkTruck.glb", (const char *[]){NULL});
    look(f, root, "ClearCoatTest.glb", (const char *[]){NULL});
    look(f, root, "cat.glb", (const char *[]){NULL});
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_refined_helmet_has_no_crack, setup, teardown),
        cmocka_unit_test_setup_teardown(a_refined_helmet_keeps_its_uvs, setup, teardown),
        cmocka_unit_test_setup_teardown(round_things_are_refined_and_others_are_not, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
