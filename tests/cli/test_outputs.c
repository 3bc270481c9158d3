/* What a render may write over, and what it may read. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tests/cli/run.h"

static const float triangle[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
static const unsigned char pixel[] = {
    0x89, 'P',  'N',  'G',  '\r', '\n', 0x1a, '\n', 0,    0,    0,    13,   'I',  'H',  'D',  'R',  0,
    0,    0,    1,    0,    0,    0,    1,    8,    0,    0,    0,    0,    0x3a, 0x7e, 0x9b, 0x55, 0,
    0,    0,    10,   'I',  'D',  'A',  'T',  0x78, 0x9c, 0x63, 0x68, 0,    0,    0,    0x82, 0,    0x81,
    0x77, 0xcd, 0x72, 0xb6, 0,    0,    0,    0,    'I',  'E',  'N',  'D',  0xae, 0x42, 0x60, 0x82};

/* a.gltf, its buffer, and two pictures, of which the second is not used. */
static void write_asset(const place *p, const char *buffer) {
    char json[1024];
    int size =
        snprintf(json, sizeof json,
                 "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
                 "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],"
                 "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],"
                 "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"a.png\"},{\"uri\":\"unused%%20one.png\"}],"
                 "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
                 "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
                 "\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}]}",
                 buffer);
    assert_true(size > 0 && (size_t)size < sizeof json);
    write_file(p, "a.gltf", json, (size_t)size);
    write_file(p, "a.png", pixel, sizeof pixel);
    write_file(p, "unused one.png", pixel, sizeof pixel);
}

static void assert_holds(const place *p, const char *name, const void *data, size_t size) {
    size_t now;
    unsigned char *bytes = read_file(p, name, &now);
    assert_non_null(bytes);
    assert_int_equal(now, size);
    assert_memory_equal(bytes, data, size);
    free(bytes);
}

#define SMALL "--size", "8x8", "--spp", "1"

static void a_render_spares_what_it_is_made_from(void **state) {
    const place *p = *state;
    static const char text[] = "overwrite a file that the asset consists of";
    write_asset(p, "a.bin");
    write_file(p, "a.bin", triangle, sizeof triangle);
    assert_refused(p, 2, text, "render", "a.gltf", SMALL); /* the default is {name}.png */
    assert_refused(p, 2, "with -o", "render", "a.gltf", SMALL, "-o", "./a.png");
    assert_refused(p, 2, text, "render", "a.gltf", SMALL, "-o", "b.png", "-o", "unused one.png");
    assert_refused(p, 2, "give --stats another name", "render", "a.gltf", SMALL, "-o", "b.png", "--stats", "a.gltf");
    assert_refused(p, 2, text, "render", "a.gltf", SMALL, "-o", "b.png", "--stats", "a.bin");
    char link[128];
    snprintf(link, sizeof link, "%s/link.png", p->folder);
    assert_int_equal(symlink("a.png", link), 0);
    assert_refused(p, 2, text, "render", "a.gltf", SMALL, "-o", "link.png");
    assert_holds(p, "a.bin", triangle, sizeof triangle);
    assert_holds(p, "a.png", pixel, sizeof pixel);
    assert_runs(p, "render", "a.gltf", SMALL, "-o", "b.png");
    assert_runs(p, "render", "a.gltf", SMALL, "-o", "b.png"); /* its own output it may */
    assert_refused(p, 2, "that --env names", "render", "a.gltf", SMALL, "--env", "b.png", "-o", "b.png");
}

/* Where it is a file too. */
static void standard_input_is_spared(void **state) {
    const place *p = *state;
    char input[128];
    write_asset(p, "a.bin");
    write_file(p, "a.bin", triangle, sizeof triangle);
    static const char glb[] = "glTF\2\0\0\0\70\0\0\0\44\0\0\0JSON{\"asset\":{\"version\":\"2.0\"}}        ";
    write_file(p, "a.glb", glb, 56);
    snprintf(input, sizeof input, "<%s/a.glb", p->folder);
    assert_runs(p, "render", "-", input, SMALL, "-o", "b.png");
    result r = run(p, "render", "-", input, SMALL, "-o", "b.png", "--stats", "a.glb");
    assert_int_equal(r.code, 2);
    assert_non_null(strstr(r.err, "a.glb: this would overwrite"));
    assert_holds(p, "a.glb", glb, 56);
    result_free(&r);
}

static void two_outputs_are_not_one_file(void **state) {
    const place *p = *state;
    assert_refused(p, 2, "./a.png: another output", "render", PAIR("unlit_a"), SMALL, "-o", "a.png", "-o", "./a.png");
    assert_refused(p, 2, "s.png: the picture's output", "render", PAIR("unlit_a"), SMALL, "-o", "s.png", "--stats",
                   "s.png");
    assert_refused(p, 2, "the picture's output", "render", PAIR("unlit_a"), SMALL, "-o", "-", "--stats", "-");
}

static void files_outside_the_folder_need_leave(void **state) {
    const place *p = *state;
    char uri[160], path[160];
    snprintf(uri, sizeof uri, "..%s/t.bin", strrchr(p->streams, '/'));
    snprintf(path, sizeof path, "%s/t.bin", p->streams);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(triangle, sizeof triangle, 1, file), 1);
    fclose(file);
    write_asset(p, uri);
    assert_refused(p, 3, "--allow-outside", "render", "a.gltf", SMALL, "-o", "b.png");
    assert_refused(p, 3, "leaves the asset's folder", "inspect", "a.gltf");
    assert_runs(p, "render", "a.gltf", SMALL, "-o", "b.png", "--allow-outside");
    assert_runs(p, "inspect", "a.gltf", "--allow-outside");
    assert_refused(p, 2, "consists of", "render", "a.gltf", SMALL, "-o", "b.png", "--allow-outside", "--stats", path);
}

int main(void) {
    const struct CMUnitTest tests[] = {CLI_TEST(a_render_spares_what_it_is_made_from),
                                       CLI_TEST(standard_input_is_spared), CLI_TEST(two_outputs_are_not_one_file),
                                       CLI_TEST(files_outside_the_folder_need_leave)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
