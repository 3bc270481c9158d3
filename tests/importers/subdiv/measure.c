/* Prints what the `auto` rule of subdivision sees: a row for each mesh of each glTF file on the command line. */
#include <stdio.h>

#include "importers/gltf/gltf.h"
#include "importers/subdiv/decide.h"
#include "scene/scene.h"

static void measure(const char *file, const kiln_scene *scene, const kiln_mesh *m, kiln_scheme scheme,
                    kiln_report *report) {
    kiln_arena arena = {0};
    kiln_cage cage;
    osd_surface once;
    smoothness s;
    char reason[160];
    cage_options options = {scheme, 0};
    if (!mesh_primvar(m, KILN_PRIMVAR_NORMAL, 0)) return;
    printf("%s '%s' %u faces, %s: ", file, m->name, m->face_count,
           scheme == KILN_SCHEME_LOOP ? "Loop" : "Catmull-Clark");
    if (!cage_build(m, &options, &arena, &cage, reason, scene->where, report)) printf("%s\n", reason);
    else if (osd_fit(&cage, &arena, scene->where, report) &&
             osd_refine(&cage, 1, &arena, &once, scene->where, report) && smoothness_measure(m, &cage, &once, &s)) {
        bool smooth = smoothness_decide(&s, reason);
        printf("quads %.1f %%, split %.1f %%, normals %.1f deg, deviation %.3f %% (worst %.3f %%), slide %.3f %%, "
               "bulge %.3f %%: %s, %s\n",
               100 * cage.quad_rate, 100 * s.split, s.normal_rad * 57.29577951, 100 * s.deviation, 100 * s.deviation_max,
               100 * s.slide, 100 * s.bulge, smooth ? "refine" : "leave", reason);
    }
    arena_free(&arena);
}

int main(int argc, char **argv) {
    kiln_report *report = kiln_report_create();
    for (int i = 1; report && i < argc; i++) {
        kiln_scene *scene = kiln_scene_create();
        if (scene && gltf_import(argv[i], &(kiln_import_options){0}, scene, report))
            for (uint32_t k = 0; k < scene->mesh_count; k++) {
                measure(argv[i], scene, &scene->meshes[k], KILN_SCHEME_CATMULL_CLARK, report);
                measure(argv[i], scene, &scene->meshes[k], KILN_SCHEME_LOOP, report);
            }
        else printf("%s: cannot be read\n", argv[i]);
        kiln_scene_destroy(scene);
    }
    kiln_report_destroy(report);
    return 0;
}
