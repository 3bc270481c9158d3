#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/cli/run.h"

/* A triangle; its parts can be replaced. */
static const char grey[] = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg==",
                  nodes[] = "[{\"mesh\":0}]", attributes[] = "{\"POSITION\":0}",
                  uri[] = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA",
                  nan_uri[] = "data:application/octet-stream;base64,AADAfwAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

static void write_gltf(const place *p, const char *the_nodes, const char *the_attributes, const char *the_uri,
                       const char *image) {
    char json[4096];
    int size =
        snprintf(json, sizeof json,
                 "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":%s,"
                 "\"meshes\":[{\"primitives\":[{\"attributes\":%s,\"material\":0}]}],"
                 "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],"
                 "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"%s\"}],"
                 "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
                 "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"
                 "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}]}",
                 the_nodes, the_attributes, image, the_uri);
    assert_true(size > 0 && (size_t)size < sizeof json);
    write_file(p, "a.gltf", json, (size_t)size);
}

/* Every file with inspect and render. */
static void assert_invalid(const place *p, const char *file, const char *text) {
    assert_refused(p, 3, text, "render", file, "--size", "8x8", "--spp", "1", "--quiet");
    assert_refused(p, 3, text, "inspect", file);
}

static void files_that_are_not_assets(void **state) {
    const place *p = *state;
    assert_invalid(p, "missing.glb", "missing.glb: the file does not exist");
    assert_invalid(p, "", "'': the file does not exist");
    assert_invalid(p, p->folder, "Is a directory");
    write_file(p, "empty.glb", "", 0);
    assert_invalid(p, "empty.glb", "the file is empty");
    write_file(p, "magic.glb", "glTG\2\0\0\0\24\0\0\0", 12);
    assert_invalid(p, "magic.glb", "neither a glb");
    write_file(p, "short.glb", "glTF\2\0\0\0\20\1\0\0\20\0\0\0JSON{}", 22);
    assert_invalid(p, "short.glb", "truncated");
    write_file(p, "car.usdz", "PK", 2);
    assert_invalid(p, "car.usdz", "does not read .usdz files");
}

static void json_that_nests_too_deep(void **state) {
    const place *p = *state;
    enum { DEPTH = 200000 };
    static const char before[] = "{\"asset\":{\"version\":\"2.0\"},\"extras\":";
    char *json = malloc(sizeof before + 2 * DEPTH + 1);
    strcpy(json, before);
    memset(json + sizeof before - 1, '[', DEPTH);
    memset(json + sizeof before - 1 + DEPTH, ']', DEPTH);
    json[sizeof before - 1 + 2 * DEPTH] = '}';
    write_file(p, "deep.gltf", json, sizeof before + 2 * DEPTH);
    free(json);
    assert_invalid(p, "deep.gltf", "nested");
}

static void references_that_lead_nowhere(void **state) {
    const place *p = *state;
    write_gltf(p, nodes, attributes, "missing.bin", grey);
    assert_invalid(p, "a.gltf", "missing.bin does not exist");
    write_gltf(p, nodes, attributes, "../a.bin", grey);
    assert_invalid(p, "a.gltf", "leaves the asset's folder");
    write_gltf(p, "[{\"mesh\":7}]", attributes, uri, grey);
    assert_invalid(p, "a.gltf", "mesh 7 does not exist");
    write_gltf(p, nodes, "{\"POSITION\":5}", uri, grey);
    assert_invalid(p, "a.gltf", "accessor 5 does not exist");
    write_gltf(p, "[{\"children\":[1]},{\"children\":[0]}]", attributes, uri, grey);
    assert_invalid(p, "a.gltf", "nodes[");
}

static void positions_that_are_no_numbers(void **state) {
    write_gltf(*state, nodes, attributes, nan_uri, grey);
    assert_invalid(*state, "a.gltf", "not finite");
}

/* Missing, without pixels, cut off behind the header, damaged in the middle: the message tells file and place. */
static void pictures_that_cannot_be_read(void **state) {
    const place *p = *state;
    static const char with_uv[] = "{\"POSITION\":0,\"TEXCOORD_0\":1}", grey_start[] = "data:image/png;base64,iVBORw0KGgoA"
        "AAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNo";
    static const unsigned char cut[] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\b\0\0\0\0\x3a\x7e\x9b\x55\0\0\0\nIDATx";
    write_gltf(p, nodes, with_uv, uri, "missing.png");
    assert_invalid(p, "a.gltf", "missing.png does not exist");
    write_gltf(p, nodes, with_uv, uri,
               "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAAAAAAECAIAAAAveKlTAAAACElEQVR4nAMAAAAAAUgGidIAAAAASUVORK5CYII=");
    assert_invalid(p, "a.gltf", "a.gltf: images[0]: ");
    write_gltf(p, nodes, with_uv, uri, grey_start);
    assert_invalid(p, "a.gltf", "a.gltf: images[0]: the PNG data ends too early");
    write_gltf(p, nodes, with_uv, uri, "cut.png");
    write_file(p, "cut.png", cut, sizeof cut - 1);
    assert_invalid(p, "a.gltf", "a.gltf: images[0] (cut.png): the PNG data ends too early");
    write_gltf(p, nodes, with_uv, uri, "damaged.png");
    write_file(p, "damaged.png", "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\b\0\0\0\0\x3a\x7e\x9b\x55\0\0\0\nIDATxxxxxxxxxxxxxx", 55);
    assert_invalid(p, "a.gltf", "a.gltf: images[0] (damaged.png): the PNG data is damaged");
}

static void surroundings_that_cannot_be_read(void **state) {
    const place *p = *state;
    assert_refused(p, 3, "hall.hdr: the file does not exist", "render", PAIR("unlit_a"), "--env", "hall.hdr");
    assert_refused(p, 3, "not a PNG", "render", PAIR("unlit_a"), "--env", PAIR("unlit_a"));
    assert_refused(p, 3, "hall.hdr: the file does not exist", "inspect", PAIR("unlit_a"), "--env", "hall.hdr");
    write_file(p, "cut.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80", 47);
    assert_refused(p, 3, "cut.hdr: the Radiance HDR data ends too early", "render", PAIR("unlit_a"), "--env", "cut.hdr",
                   "--quiet");
    assert_refused(p, 3, "cut.hdr: the Radiance HDR data ends too early", "inspect", PAIR("unlit_a"), "--env", "cut.hdr");
    assert_refused(p, 3, "c.ocio: the file does not exist", "render", PAIR("unlit_a"), "--ocio", "c.ocio");
    assert_refused(p, 3, "c.ocio ($OCIO): the file does not exist", "OCIO=c.ocio", "render", PAIR("unlit_a"));
}

/* They are called by name, and nobody is told to look for them in a folder. */
static void streams_that_fail(void **state) {
    const place *p = *state;
    static const char glb[] = "glTF\2\0\0\0\130\0\0\0\104\0\0\0JSON"
                              "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":1,\"uri\":\"a\"}]}  ";
    char input[128];
    write_file(p, "a.glb", glb, sizeof glb - 1);
    snprintf(input, sizeof input, "<%s/a.glb", p->folder);
    assert_refused(p, 3, "give the asset by its path", "inspect", "-", input);
    snprintf(input, sizeof input, "<%s", p->folder);
    assert_refused(p, 3, "standard input: it cannot be read: Is a directory", "inspect", "-", input);
}

static void outputs_that_cannot_be_written(void **state) {
    const place *p = *state;
    write_file(p, "file", "", 0);
    assert_refused(p, 1, "nowhere/a.png", "render", PAIR("unlit_a"), "-o", "nowhere/a.png");
    assert_refused(p, 1, "file/a.png", "render", PAIR("unlit_a"), "-o", "a.png", "-o", "file/a.png");
    assert_refused(p, 1, "nowhere/s.json", "render", PAIR("unlit_a"), "--stats", "nowhere/s.json");
    assert_refused(p, 2, "no format that kiln writes", "render", PAIR("unlit_a"), "-o", "a.bmp");
    assert_refused(p, 2, "JPEG cannot be transparent", "render", PAIR("unlit_a"), "-o", "a.jpg", "--background",
                   "transparent");
    assert_refused(p, 2, "cannot be filled in", "render", PAIR("unlit_a"), "-o", "{nonsense}.png");
}

static void pictures_that_no_memory_holds(void **state) {
    assert_refused(*state, 2, "--size: 65536 x 65536 pixels need", "render", PAIR("unlit_a"), "--size", "65536x65536");
}

/* The message is one line, whatever the names in the file are. */
static void names_cannot_write_lines(void **state) {
    write_gltf(*state, "[{\"name\":\"a\\nb\\u001b[2J\",\"mesh\":7}]", attributes, uri, grey);
    assert_invalid(*state, "a.gltf", "mesh 7");
}

int main(void) {
    const struct CMUnitTest tests[] = {CLI_TEST(files_that_are_not_assets),
                                       CLI_TEST(json_that_nests_too_deep),
                                       CLI_TEST(references_that_lead_nowhere),
                                       CLI_TEST(positions_that_are_no_numbers),
                                       CLI_TEST(pictures_that_cannot_be_read),
                                       CLI_TEST(surroundings_that_cannot_be_read),
                                       CLI_TEST(streams_that_fail),
                                       CLI_TEST(outputs_that_cannot_be_written),
                                       CLI_TEST(pictures_that_no_memory_holds),
                                       CLI_TEST(names_cannot_write_lines)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
