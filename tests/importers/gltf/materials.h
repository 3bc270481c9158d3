/* tests/importers/gltf/materials.h: documents of one material. Texture 0 has no sampler, texture 1 one. */
#ifndef KILN_TESTS_IMPORTERS_GLTF_MATERIALS_H
#define KILN_TESTS_IMPORTERS_GLTF_MATERIALS_H

#include <math.h>

#include "tests/importers/gltf/support.h"

#define TEXTURES "'images': [{'uri': '" PIXEL "'}], 'textures': [{'source': 0}, {'source': 0, 'sampler': 0}], " \
                 "'samplers': [{'wrapS': 33071, 'wrapT': 33648, 'magFilter': 9728}], "

/* Of the last import; tear_down destroys it. */
static kiln_scene *scene;

static inline const kiln_material *material(const char *json) {
    kiln_text rest = {0};
    text_format(&rest, TEXTURES TRIANGLE ", 'nodes': [{'mesh': 0}], 'materials': [{%s}]", json);
    scene = import_good(TRIANGLE_DATA, rest.data);
    text_free(&rest);
    return scene_material(scene, 1);
}

static inline void refused(const char *json, kiln_code code, const char *where, const char *what) {
    kiln_text rest = {0};
    text_format(&rest, TEXTURES TRIANGLE ", 'nodes': [{'mesh': 0}], 'materials': [{%s}]", json);
    import_bad(TRIANGLE_DATA, rest.data, code, where, what);
    text_free(&rest);
}

static inline const kiln_material *warned(const char *json, kiln_code code, const char *where, const char *what) {
    kiln_text rest = {0};
    text_format(&rest, TEXTURES TRIANGLE ", 'nodes': [{'mesh': 0}], 'materials': [{%s}]", json);
    scene = import_warned(TRIANGLE_DATA, rest.data, code, where, what);
    text_free(&rest);
    return scene_material(scene, 1);
}

static inline int tear_down(void **state) {
    (void)state;
    kiln_scene_destroy(scene);
    scene = NULL;
    return 0;
}

/* A material with one extension. */
#define EXTENDED(name, members) "'extensions': {'" name "': {" members "}}"

#endif
