#include "kiln/import.h"

#include <string.h>

#include "base/file.h"
#include "importers/gltf/gltf.h"

/* The content decides, whatever the name says; a suffix of another format is a better message. */
static bool check_suffix(const char *path, kiln_report *report) {
    static const char *const others[] = {".usd", ".usda",  ".usdc", ".usdz", ".obj",
                                         ".fbx", ".blend", ".abc",  ".stl",  ".ply"};
    char suffix[16];
    path_suffix(path, suffix);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (strcmp(suffix, others[i]) == 0) {
            kiln_where where = where_root(path);
            return report_error(report, KILN_CODE_FILE_FORMAT, &where, "convert it to .gltf or .glb",
                                "kiln does not read %s files", suffix);
        }
    return true;
}

bool kiln_import(const char *path, const kiln_import_options *options, kiln_scene **scene, kiln_report *report) {
    *scene = NULL;
    if (!check_suffix(path, report)) return false;
    kiln_scene *filled = kiln_scene_create();
    if (!filled) return report_no_memory(report, "importing a scene");
    if (!gltf_import(path, options, filled, report)) {
        kiln_scene_destroy(filled);
        return false;
    }
    *scene = filled;
    return true;
}
