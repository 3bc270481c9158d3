/* A libFuzzer target: build with clang and -DKILN_FUZZ=ON, run fuzz_gltf on a folder of .gltf and .glb files. */
#include "importers/gltf/gltf.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = kiln_scene_create();
    kiln_import_options options = {.memory_limit = 64 << 20};
    if (report && scene && gltf_import_memory("fuzz", data, size, NULL, &options, scene, report))
        kiln_scene_commit(scene, report);
    kiln_scene_destroy(scene);
    if (report) kiln_report_destroy(report);
    return 0;
}
