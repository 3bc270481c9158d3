#include "tests/importers/gltf/support.h"

#include <sys/stat.h>
#include <unistd.h>

/* A grey PNG of 1 × 1. */
static const unsigned char pixel[67] = {
    0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
    0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00, 0x00, 0x3A, 0x7E, 0x9B, 0x55, 0x00, 0x00,
    0x00, 0x0A, 0x49, 0x44, 0x41, 0x54, 0x78, 0xDA, 0x63, 0x68, 0x00, 0x00, 0x00, 0x82, 0x00, 0x81, 0xDA,
    0x45, 0x08, 0x3B, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};

static char folder[] = "/tmp/kiln-image-XXXXXX";

static void put(const char *name, const void *data, size_t size) {
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fwrite(data, 1, size, f);
    fclose(f);
}

static unsigned char ktx2[80] = {0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n', 0x1A, '\n'};

static int set_up(void **state) {
    (void)state;
    if (!mkdtemp(folder)) return -1;
    unsigned char empty[sizeof pixel];
    memcpy(empty, pixel, sizeof pixel);
    memset(empty + 16, 0, 4); /* a width of 0 */
    put("a b.png", pixel, sizeof pixel);
    put("empty.png", "", 0);
    put("flat.png", empty, sizeof empty);
    put("cut.png", pixel, 20);
    put("text.png", "hello, this is no picture at all", 32);
    put("t.ktx2", ktx2, sizeof ktx2);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    static const char *const names[] = {"a b.png", "empty.png", "flat.png", "cut.png", "text.png", "t.ktx2"};
    char path[128];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        unlink(path);
    }
    return rmdir(folder);
}

static kiln_scene *import_image(const char *image, kiln_report *report) {
    char rest[600];
    snprintf(rest, sizeof rest, "'images': [%s], 'textures': [{'source': 0}], 'materials': [{'emissiveTexture': {'index': 0}}]", image);
    char *json = document(NULL, 0, rest);
    kiln_scene *scene = kiln_scene_create();
    if (!gltf_import_memory("test.gltf", json, strlen(json), folder, NULL, scene, report)) {
        kiln_scene_destroy(scene);
        scene = NULL;
    }
    free(json);
    return scene;
}

static void refused(const char *image, kiln_code code, const char *where, const char *what) {
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = import_image(image, report);
    if (scene) print_message("accepted %s\n", image);
    assert_null(scene);
    assert_message(report, KILN_ERROR, code, where, what);
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 1);
    kiln_report_destroy(report);
}

static void reads_files(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = import_image("{'uri': 'a%20b.png', 'mimeType': 'image/jpeg'}", report); /* which it is not */
    assert_non_null(scene);
    const kiln_image_desc *image = scene_image(scene, 1);
    assert_string_equal(image->name, "a%20b.png");
    assert_int_equal(image->encoded_size, sizeof pixel);
    assert_memory_equal(image->encoded, pixel, sizeof pixel);
    assert_non_null(image->release); /* not copied */
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 0);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
}

static void reads_data_uris(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    char *uri = data_uri(pixel, sizeof pixel), image[300];
    snprintf(image, sizeof image, "{'name': 'dot', 'uri': '%s'}", uri); /* application/octet-stream */
    kiln_scene *scene = import_image(image, report);
    assert_non_null(scene);
    assert_string_equal(scene_image(scene, 1)->name, "dot");
    assert_memory_equal(scene_image(scene, 1)->encoded, pixel, sizeof pixel);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
    free(uri);
}

static void refuses_bad_images(void **state) {
    (void)state;
    refused("{'uri': 'gone.png'}", KILN_CODE_FILE_MISSING, "images[0].uri", "gone.png does not exist");
    refused("{'uri': '../a.png'}", KILN_CODE_PATH_OUTSIDE, "images[0].uri", "leaves the asset's folder");
    refused("{'uri': '.'}", KILN_CODE_FILE_UNREADABLE, "images[0].uri", "");
    refused("{'uri': 't.ktx2'}", KILN_CODE_IMAGE, "images[0]", "KHR_texture_basisu");
    refused("{'mimeType': 'image/png'}", KILN_CODE_REFERENCE, "images[0]", "neither uri nor bufferView");
    refused("{'uri': 'a%20b.png', 'bufferView': 0}", KILN_CODE_REFERENCE, "images[0].bufferView", "buffer view 0");
    refused("{'bufferView': 3}", KILN_CODE_REFERENCE, "images[0].bufferView", "buffer view 3 does not exist");
    static const char *const broken[] = {"empty.png", "flat.png", "cut.png", "text.png"};
    for (size_t i = 0; i < 4; i++) {
        char image[60];
        snprintf(image, sizeof image, "{'uri': '%s'}", broken[i]);
        kiln_report *report = kiln_report_create();
        assert_null(import_image(image, report));
        assert_int_equal(kiln_report_exit_code(report), 3);
        assert_int_equal(kiln_report_count(report, KILN_ERROR), 1);
        assert_non_null(strstr(kiln_report_message(report, 0).where, "images[0]"));
        kiln_report_destroy(report);
    }
}

/* Nobody looks at an image that no material shows. */
static void leaves_unused_images_alone(void **state) {
    (void)state;
    kiln_scene *scene = import_good(TRIANGLE_DATA, TRIANGLE ", 'nodes': [{'mesh': 0}], 'images': [{'uri': 'gone.png'}]");
    assert_int_equal(scene->image_count, 0);
    kiln_scene_destroy(scene);
}

static kiln_scene *import_embedded(size_t other_bytes) {
    size_t size = sizeof pixel + other_bytes;
    unsigned char *data = calloc(1, size);
    memcpy(data, pixel, sizeof pixel);
    char rest[600];
    snprintf(rest, sizeof rest, "'bufferViews': [{'buffer': 0, 'byteLength': %zu}], 'images': [{'bufferView': 0, 'mimeType': 'image/png'}], "
             "'textures': [{'source': 0}], 'materials': [{'emissiveTexture': {'index': 0}}]", sizeof pixel);
    char *json = document(data, size, rest);
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = import_text(json, report);
    assert_non_null(scene);
    assert_memory_equal(scene_image(scene, 1)->encoded, pixel, sizeof pixel);
    kiln_report_destroy(report);
    free(json);
    free(data);
    return scene;
}

/* A buffer of images is kept; out of one full of geometry they are copied. */
static void keeps_buffers_of_images_alone(void **state) {
    (void)state;
    kiln_scene *scene = import_embedded(10);
    assert_non_null(scene_image(scene, 1)->release);
    kiln_scene_destroy(scene);
    scene = import_embedded(1000);
    assert_null(scene_image(scene, 1)->release);
    kiln_scene_destroy(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_files),        cmocka_unit_test(reads_data_uris),
        cmocka_unit_test(refuses_bad_images), cmocka_unit_test(leaves_unused_images_alone),
        cmocka_unit_test(keeps_buffers_of_images_alone),
    };
    return cmocka_run_group_tests_name("image", tests, set_up, tear_down);
}
