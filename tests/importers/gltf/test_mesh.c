#include "tests/importers/gltf/support.h"

/* A buffer of 8 positions, 8 normals, 8 UVs and 16-bit indices, of which documents take what they need. */
typedef struct data {
    float positions[24], normals[24], uvs[16], tangents[32];
    uint16_t indices[16];
} data;

static data fill(const uint16_t *indices, size_t count) {
    data d = {{0}, {0}, {0}, {0}, {0}};
    for (int i = 0; i < 8; i++) {
        d.positions[3 * i] = (float)i;
        d.positions[3 * i + 1] = (float)(i % 2);
        d.positions[3 * i + 2] = (float)(i * i) * 0.125f;
        d.normals[3 * i + 2] = 1;
        d.uvs[2 * i] = (float)i * 0.125f;
        d.uvs[2 * i + 1] = (float)(i % 3);
        d.tangents[4 * i] = 1;
        d.tangents[4 * i + 3] = 1;
    }
    memcpy(d.indices, indices, count * sizeof *indices);
    return d;
}

/* Accessors: 0 positions, 1 normals, 2 UVs, 3 tangents, 4 the first `count` indices, 5 the next `more`. */
static char *rest_of(size_t count, size_t more, const char *primitives, const char *tail) {
    kiln_text t = {0};
    text_format(&t,
                "'bufferViews': [{'buffer': 0, 'byteLength': 96}, {'buffer': 0, 'byteOffset': 96, 'byteLength': 96}, "
                "{'buffer': 0, 'byteOffset': 192, 'byteLength': 64}, {'buffer': 0, 'byteOffset': 256, 'byteLength': 128}, "
                "{'buffer': 0, 'byteOffset': 384, 'byteLength': 32}], 'accessors': ["
                "{'bufferView': 0, 'componentType': 5126, 'count': 8, 'type': 'VEC3'}, "
                "{'bufferView': 1, 'componentType': 5126, 'count': 8, 'type': 'VEC3'}, "
                "{'bufferView': 2, 'componentType': 5126, 'count': 8, 'type': 'VEC2'}, "
                "{'bufferView': 3, 'componentType': 5126, 'count': 8, 'type': 'VEC4'}, "
                "{'bufferView': 4, 'componentType': 5123, 'count': %zu, 'type': 'SCALAR'}, "
                "{'bufferView': 4, 'byteOffset': %zu, 'componentType': 5123, 'count': %zu, 'type': 'SCALAR'}], "
                "'meshes': [{'name': 'm', 'primitives': [%s]}], 'nodes': [{'mesh': 0}]%s",
                count, 2 * count, more ? more : 1, primitives, tail);
    return text_take(&t);
}

static kiln_scene *good(const data *d, size_t count, size_t more, const char *primitives, const char *tail) {
    char *rest = rest_of(count, more, primitives, tail);
    kiln_scene *scene = import_good(d, sizeof *d, rest);
    free(rest);
    return scene;
}
static kiln_scene *warned(const data *d, size_t count, const char *primitives, const char *where, const char *what) {
    char *rest = rest_of(count, 0, primitives, "");
    kiln_scene *scene = import_warned(d, sizeof *d, rest, KILN_CODE_IGNORED, where, what);
    free(rest);
    return scene;
}
static void bad(const data *d, size_t count, const char *primitives, kiln_code code, const char *where, const char *what) {
    char *rest = rest_of(count, 0, primitives, "");
    import_bad(d, sizeof *d, rest, code, where, what);
    free(rest);
}

static void assert_faces(const kiln_scene *scene, const uint32_t *expected, uint32_t triangles) {
    const kiln_mesh *m = scene_mesh(scene, 1);
    assert_int_equal(m->face_count, triangles);
    for (uint32_t i = 0; i < 3 * triangles; i++) {
        uint32_t id = (uint32_t)m->positions[3 * m->face_vertices[i]]; /* x is the vertex's number in the file */
        if (id != expected[i]) fail_msg("corner %u is vertex %u, expected %u", i, id, expected[i]);
    }
}

static const uint16_t six[6] = {0, 1, 2, 3, 4, 5};

/* Section 3.7.2.1: strips turn every other triangle, fans begin with the next two corners. */
static void winds_every_mode(void **state) {
    (void)state;
    data d = fill(six, 6);
    const uint32_t list[6] = {0, 1, 2, 3, 4, 5}, strip[12] = {0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4},
                   fan[12] = {1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0};
    const struct { int mode; const uint32_t *faces; uint32_t count; } rows[] = {{4, list, 2}, {5, strip, 4}, {6, fan, 4}};
    for (int i = 0; i < 3; i++) {
        char primitive[100];
        snprintf(primitive, sizeof primitive, "{'attributes': {'POSITION': 0}, 'indices': 4, 'mode': %d}", rows[i].mode);
        kiln_scene *scene = good(&d, 6, 0, primitive, "");
        assert_faces(scene, rows[i].faces, rows[i].count);
        kiln_scene_destroy(scene);
    }
}

static void counts_without_indices(void **state) {
    (void)state;
    data d = fill(six, 6);
    const uint32_t list[6] = {0, 1, 2, 3, 4, 5}; /* 8 vertices: the incomplete triangle is left out */
    kiln_scene *scene = good(&d, 6, 0, "{'attributes': {'POSITION': 0}}", "");
    assert_faces(scene, list, 2);
    kiln_scene_destroy(scene);
}

static void drops_stitches(void **state) {
    (void)state;
    const uint16_t stitched[8] = {0, 1, 2, 2, 3, 3, 4, 5};
    const uint32_t faces[6] = {0, 1, 2, 3, 5, 4};
    data d = fill(stitched, 8);
    kiln_scene *scene = good(&d, 8, 0, "{'attributes': {'POSITION': 0}, 'indices': 4, 'mode': 5}", "");
    assert_faces(scene, faces, 2);
    kiln_scene_destroy(scene);
}

static void checks_indices(void **state) {
    (void)state;
    const uint16_t beyond[3] = {0, 1, 8}, restart[4] = {0, 1, 2, 65535};
    data d = fill(beyond, 3);
    bad(&d, 3, "{'attributes': {'POSITION': 0}, 'indices': 4}", KILN_CODE_RANGE, "meshes[0].primitives[0].indices",
        "index 2 is 8, but there are only 8 vertices");
    d = fill(restart, 4);
    bad(&d, 4, "{'attributes': {'POSITION': 0}, 'indices': 4, 'mode': 5}", KILN_CODE_RANGE, "primitives[0].indices",
        "primitive restart");
    bad(&d, 3, "{'attributes': {'POSITION': 0}, 'indices': 0}", KILN_CODE_RANGE, "primitives[0].indices",
        "does not hold unsigned integers");
    bad(&d, 3, "{'attributes': {'POSITION': 0}, 'indices': 4, 'mode': 7}", KILN_CODE_RANGE, "primitives[0].mode", "no primitive mode");
}

static void checks_attributes(void **state) {
    (void)state;
    data d = fill(six, 6);
    bad(&d, 6, "{'attributes': {'POSITION': 2}}", KILN_CODE_RANGE, "attributes.POSITION", "vectors of 3");
    bad(&d, 6, "{'attributes': {'POSITION': 0, 'NORMAL': 3}}", KILN_CODE_RANGE, "attributes.NORMAL", "vectors of 3");
    bad(&d, 6, "{'attributes': {'POSITION': 0, 'COLOR_0': 2}}", KILN_CODE_RANGE, "attributes.COLOR_0", "vectors of 3 or more");
    bad(&d, 6, "{'attributes': {'POSITION': 0, 'NORMAL': 9}}", KILN_CODE_REFERENCE, "attributes.NORMAL", "accessor 9 does not exist");
    bad(&d, 6, "{'attributes': {'POSITION': 0}, 'material': 2}", KILN_CODE_REFERENCE, "primitives[0].material", "material 2");
    d.positions[10] = NAN;
    bad(&d, 6, "{'attributes': {'POSITION': 0}, 'indices': 4}", KILN_CODE_GEOMETRY, "meshes[0]", "vertex 3");
}

static void counts_points_and_lines_once(void **state) {
    (void)state;
    data d = fill(six, 6);
    char *rest = rest_of(6, 0, "{'attributes': {'POSITION': 0}, 'mode': 0}, {'attributes': {'POSITION': 0}, 'mode': 3}, "
                               "{'attributes': {'POSITION': 0}, 'indices': 4}", "");
    char *json = document(&d, sizeof d, rest);
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = import_text(json, report);
    assert_non_null(scene);
    assert_int_equal(kiln_report_size(report), 1);
    assert_int_equal(kiln_report_message(report, 0).count, 2);
    assert_message(report, KILN_WARNING, KILN_CODE_IGNORED, "meshes[0].primitives[0]", "points and lines");
    assert_int_equal(scene_mesh(scene, 1)->face_count, 2);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
    free(json);
    free(rest);
}

static void leaves_out_what_has_no_positions(void **state) {
    (void)state;
    data d = fill(six, 6);
    kiln_scene *scene = warned(&d, 6, "{'attributes': {'NORMAL': 1}}", "primitives[0]", "without positions");
    assert_int_equal(scene->mesh_count, 0);
    assert_int_equal(scene->instance_count, 0);
    kiln_scene_destroy(scene);
}

static const char two_materials[] = ", 'materials': [{'name': 'a'}, {'name': 'b'}]";

/* Two primitives of one vertex buffer share its vertices; faces keep their materials. */
static void shares_vertices(void **state) {
    (void)state;
    data d = fill(six, 6);
    kiln_scene *scene = good(&d, 3, 3, "{'attributes': {'POSITION': 0, 'NORMAL': 1}, 'indices': 4, 'material': 1}, "
                                       "{'attributes': {'POSITION': 0, 'NORMAL': 1}, 'indices': 5}", two_materials);
    const kiln_mesh *m = scene_mesh(scene, 1);
    assert_int_equal(m->vertex_count, 6); /* of 8: unused ones are dropped */
    assert_int_equal(m->face_count, 2);
    assert_int_equal(m->face_materials[0], 2);
    assert_int_equal(m->face_materials[1], 0);
    kiln_scene_destroy(scene);
}

/* One with normals, one without: the latter's are zero, which stands for the face's own. */
static void unites_attributes(void **state) {
    (void)state;
    data d = fill(six, 6);
    kiln_scene *scene = good(&d, 3, 3, "{'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2}, 'indices': 4}, "
                                       "{'attributes': {'POSITION': 0, 'COLOR_0': 1}, 'indices': 5}", two_materials);
    const kiln_mesh *m = scene_mesh(scene, 1);
    assert_int_equal(m->vertex_count, 6);
    assert_null(m->face_materials);
    const kiln_primvar *normal = mesh_primvar(m, KILN_PRIMVAR_NORMAL, 0), *uv = mesh_primvar(m, KILN_PRIMVAR_UV, 0),
                       *color = mesh_primvar(m, KILN_PRIMVAR_COLOR, 0);
    const float n[18] = {0, 0, 1, 0, 0, 1, 0, 0, 1}, t[12] = {0, 0, 0.125f, 1, 0.25f, 2};
    const float c[12] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    assert_floats(normal->values, n, 18);
    assert_floats(uv->values, t, 12);
    assert_floats(color->values, c, 12);
    assert_floats(color->values + 12, (float[]){0, 0, 1, 1}, 4); /* a VEC3 has alpha 1 */
    kiln_scene_destroy(scene);
}

static void drops_unused_vertices(void **state) {
    (void)state;
    const uint16_t few[3] = {7, 2, 5};
    data d = fill(few, 3);
    d.positions[0] = NAN; /* of a vertex that nothing uses */
    kiln_scene *scene = good(&d, 3, 0, "{'attributes': {'POSITION': 0, 'TEXCOORD_0': 2}, 'indices': 4}",
                             ", 'extras': 1");
    const kiln_mesh *m = scene_mesh(scene, 1);
    const float x[3] = {2, 5, 7}, uv[6] = {0.25f, 2, 0.625f, 2, 0.875f, 1};
    const uint32_t corners[3] = {2, 0, 1};
    assert_int_equal(m->vertex_count, 3);
    for (int i = 0; i < 3; i++) assert_floats(&m->positions[3 * i], &x[i], 1);
    assert_memory_equal(m->face_vertices, corners, sizeof corners);
    assert_floats(mesh_primvar(m, KILN_PRIMVAR_UV, 0)->values, uv, 6);
    kiln_scene_destroy(scene);
}

static void completes_normals_and_tangents(void **state) {
    (void)state;
    data d = fill(six, 6);
    kiln_scene *scene = good(&d, 6, 0, "{'attributes': {'POSITION': 0, 'TANGENT': 3}, 'indices': 4}", "");
    const kiln_mesh *m = scene_mesh(scene, 1);
    assert_int_equal(mesh_primvar(m, KILN_PRIMVAR_NORMAL, 0)->interpolation, KILN_UNIFORM);
    assert_null(mesh_primvar(m, KILN_PRIMVAR_TANGENT, 0)); /* section 3.7.2.1: without normals, tangents are ignored */
    kiln_scene_destroy(scene);
    scene = good(&d, 6, 0, "{'attributes': {'POSITION': 0, 'NORMAL': 1, 'TANGENT': 3}, 'indices': 4}", "");
    assert_int_equal(mesh_primvar(scene_mesh(scene, 1), KILN_PRIMVAR_TANGENT, 0)->interpolation, KILN_VERTEX);
    kiln_scene_destroy(scene);
}

/* A part with a normal map and without tangents: they are computed for all parts, or some would fit no other. */
static void keeps_tangents_where_all_have_them(void **state) {
    (void)state;
    data d = fill(six, 6);
    static const char mapped[] = ", 'materials': [{'normalTexture': {'index': 0}}, {}], 'textures': [{'source': 0}], "
                                 "'images': [{'uri': '" PIXEL "'}]";
    static const struct { const char *second; kiln_interpolation kept; } rows[] = {
        {"{'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2}, 'indices': 5, 'material': 0}", KILN_FACE_VARYING},
        {"{'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2}, 'indices': 5, 'material': 1}", KILN_VERTEX},
        {"{'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2, 'TANGENT': 3}, 'indices': 5, 'material': 0}", KILN_VERTEX}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char primitives[400];
        snprintf(primitives, sizeof primitives, "{'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2, 'TANGENT': 3}, "
                 "'indices': 4, 'material': 0}, %s", rows[i].second);
        char *rest = rest_of(3, 3, primitives, mapped), *json = document(&d, sizeof d, rest);
        kiln_report *report = kiln_report_create();
        kiln_scene *scene = import_text(json, report);
        assert_non_null(scene);
        assert_int_equal(mesh_primvar(scene_mesh(scene, 1), KILN_PRIMVAR_TANGENT, 0)->interpolation, rows[i].kept);
        kiln_scene_destroy(scene);
        kiln_report_destroy(report);
        free(json);
        free(rest);
    }
}

static void reads_integer_colors_as_normalized(void **state) {
    (void)state;
    data d = fill(six, 6);
    kiln_scene *scene = import_warned(&d, sizeof d,
        "'bufferViews': [{'buffer': 0, 'byteLength': 96}, {'buffer': 0, 'byteOffset': 384, 'byteLength': 32}], 'accessors': ["
        "{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}, "
        "{'bufferView': 1, 'componentType': 5121, 'count': 3, 'type': 'VEC4'}], "
        "'meshes': [{'primitives': [{'attributes': {'POSITION': 0, 'COLOR_0': 1}}]}], 'nodes': [{'mesh': 0}]",
        KILN_CODE_RANGE, "attributes.COLOR_0", "not normalized");
    const float c[4] = {0, 0, 1 / 255.0f, 0}; /* the bytes of 0, 1 */
    assert_floats(mesh_primvar(scene_mesh(scene, 1), KILN_PRIMVAR_COLOR, 0)->values, c, 4);
    kiln_scene_destroy(scene);
}

static void reads_subdivision(void **state) {
    (void)state;
    const uint16_t indices[6] = {0, 1, 2, 5, 6, 7};
    data d = fill(indices, 6);
    char *rest = rest_of(6, 0, "{'attributes': {'POSITION': 0}, 'indices': 4}], 'extras': {'subdivision': {'scheme': 'loop', "
                               "'level': 3, 'creases': [[6, 7, 2.5], [0, 1, 10], [3, 4, 1]], 'corners': [[5, 4]]}}, 'x': [0", "");
    char *json = document(&d, sizeof d, rest);
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = import_text(json, report);
    assert_non_null(scene);
    const kiln_subdivision *s = &scene_mesh(scene, 1)->subdivision;
    assert_int_equal(s->scheme, KILN_SCHEME_LOOP);
    assert_int_equal(s->level, 3);
    assert_true(s->triangulated);
    assert_false(s->fan_encoded);
    /* Vertices 3 and 4 of the file are in no face, 5 to 7 have become 3 to 5. */
    const uint32_t creases[4] = {4, 5, 0, 1};
    const float sharpness[2] = {2.5f, 10};
    assert_int_equal(s->crease_count, 2);
    assert_memory_equal(s->crease_vertices, creases, sizeof creases);
    assert_floats(s->crease_sharpness, sharpness, 2);
    assert_int_equal(s->corner_count, 1);
    assert_int_equal(s->corner_vertices[0], 3);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
    free(json);
    free(rest);
}

static void understands_short_forms(void **state) {
    (void)state;
    static const struct { const char *extras; kiln_scheme scheme; int level; } rows[] = {
        {"'catmull-clark'", KILN_SCHEME_CATMULL_CLARK, 0}, {"'none'", KILN_SCHEME_NONE, 0}, {"4", KILN_SCHEME_AUTO, 4},
        {"{'scheme': 'bilinear'}", KILN_SCHEME_BILINEAR, 0}, {"{'level': 1}", KILN_SCHEME_AUTO, 1}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char rest[600];
        snprintf(rest, sizeof rest, TRIANGLE ", 'nodes': [{'mesh': 0, 'extras': {'subdivision': %s}}]", rows[i].extras);
        kiln_scene *scene = import_good(TRIANGLE_DATA, rest);
        assert_int_equal(scene_mesh(scene, 1)->subdivision.scheme, rows[i].scheme);
        assert_int_equal(scene_mesh(scene, 1)->subdivision.level, rows[i].level);
        kiln_scene_destroy(scene);
    }
    static const char *const strange[] = {"'cubic'", "1.5", "99", "true", "{'level': 'x'}", "{'creases': [[1, 2]]}",
                                          "{'corners': [1]}", "{'creases': [[-1, 2, 3]]}"};
    for (size_t i = 0; i < sizeof strange / sizeof *strange; i++) {
        char rest[600];
        snprintf(rest, sizeof rest, TRIANGLE ", 'nodes': [{'mesh': 0, 'extras': {'subdivision': %s}}]", strange[i]);
        kiln_scene *scene = import_warned(TRIANGLE_DATA, rest, KILN_CODE_IGNORED, "nodes[0].extras.subdivision", "not understood");
        assert_int_equal(scene_mesh(scene, 1)->subdivision.scheme, KILN_SCHEME_AUTO);
        assert_int_equal(scene_mesh(scene, 1)->subdivision.crease_count, 0);
        kiln_scene_destroy(scene);
    }
}

static void knows_encoded_polygons(void **state) {
    (void)state;
    data d = fill(six, 6);
    const char *with = "{'attributes': {'POSITION': 0}, 'indices': 4, 'extensions': {'FB_ngon_encoding': {}}}";
    kiln_scene *scene = good(&d, 6, 0, with, "");
    assert_true(scene_mesh(scene, 1)->subdivision.fan_encoded);
    kiln_scene_destroy(scene);
    char both[400];
    snprintf(both, sizeof both, "%s, {'attributes': {'POSITION': 0}, 'indices': 4}", with);
    scene = good(&d, 6, 0, both, "");
    assert_false(scene_mesh(scene, 1)->subdivision.fan_encoded);
    kiln_scene_destroy(scene);
}

/* The place is the accessor's user, whichever primitive it is. */
static void says_which_positions_are_no_numbers(void **state) {
    (void)state;
    float positions[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, NAN, 0};
    import_bad(positions, sizeof positions,
               "'bufferViews': [{'buffer': 0, 'byteLength': 72}], "
               "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}, "
               "{'bufferView': 0, 'byteOffset': 36, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}], "
               "'meshes': [{'name': 'm', 'primitives': [{'attributes': {'POSITION': 0}}, "
               "{'attributes': {'POSITION': 1}}]}], 'nodes': [{'mesh': 0}]",
               KILN_CODE_GEOMETRY, "test.gltf: meshes[0].primitives[1].attributes.POSITION",
               "vertex 2 has a position that is not finite");
}

/* In the file's words alone: numbers of the scene's own would point elsewhere. */
static void places_are_the_files(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    char *json = document(TRIANGLE_DATA, TRIANGLE ", 'nodes': [{'name': 'n'}, {'mesh': 0, 'scale': [0, 1, 1]}]");
    kiln_scene *scene = import_text(json, report);
    assert_non_null(scene);
    assert_int_equal(kiln_report_size(report), 1);
    assert_string_equal(kiln_report_message(report, 0).where, "test.gltf: nodes[1]");
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
    free(json);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(winds_every_mode),
        cmocka_unit_test(counts_without_indices),
        cmocka_unit_test(drops_stitches),
        cmocka_unit_test(checks_indices),
        cmocka_unit_test(checks_attributes),
        cmocka_unit_test(counts_points_and_lines_once),
        cmocka_unit_test(leaves_out_what_has_no_positions),
        cmocka_unit_test(shares_vertices),
        cmocka_unit_test(unites_attributes),
        cmocka_unit_test(drops_unused_vertices),
        cmocka_unit_test(completes_normals_and_tangents),
        cmocka_unit_test(keeps_tangents_where_all_have_them),
        cmocka_unit_test(reads_integer_colors_as_normalized),
        cmocka_unit_test(reads_subdivision),
        cmocka_unit_test(understands_short_forms),
        cmocka_unit_test(knows_encoded_polygons),
        cmocka_unit_test(says_which_positions_are_no_numbers),
        cmocka_unit_test(places_are_the_files),
    };
    return cmocka_run_group_tests_name("mesh", tests, NULL, NULL);
}
