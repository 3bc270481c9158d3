#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <openexr.h>

#include "support.h"

static kiln_bytes write_exr(const kiln_exr_file *file) {
    folder f = folder_make("a.exr");
    kiln_report *report = kiln_report_create();
    if (!image_write_exr(f.file, file, report)) {
        print_report(report);
        fail();
    }
    kiln_report_destroy(report);
    kiln_bytes bytes = read_whole(f.file);
    folder_remove(&f);
    return bytes;
}

static int64_t read_bytes(exr_const_context_t context, void *user, void *to, uint64_t count, uint64_t offset,
                          exr_stream_error_func_ptr_t error) {
    (void)context, (void)error;
    kiln_bytes *bytes = user;
    uint64_t left = offset < bytes->size ? bytes->size - offset : 0, take = count < left ? count : left;
    memcpy(to, bytes->data + offset, take);
    return (int64_t)take;
}

static exr_context_t open_exr(kiln_bytes *bytes) {
    exr_context_t file;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.user_data = bytes;
    setup.read_fn = read_bytes;
    assert_int_equal(exr_start_read(&file, "file", &setup), EXR_ERR_SUCCESS);
    return file;
}

static float *noise(size_t count) {
    float *values = malloc(count * sizeof *values);
    for (size_t i = 0; i < count; i++) values[i] = unit_float(hash32((uint32_t)i)) * 100 - 20;
    return values;
}

/* Interleaved RGB at half and full precision, through the file and back. */
static void pixels_come_back(void **state) {
    (void)state;
    enum { WIDTH = 70, HEIGHT = 37 };
    float *values = noise(WIDTH * HEIGHT * 3);
    for (int full = 0; full <= 1; full++) {
        const kiln_exr_channel channels[3] = {
            {"R", values, 3, full}, {"G", values + 1, 3, full}, {"B", values + 2, 3, full}};
        kiln_bytes file =
            write_exr(&(kiln_exr_file){.width = WIDTH, .height = HEIGHT, .channels = channels, .channel_count = 3});
        kiln_image image = decode_well(file.data, file.size);
        assert_int_equal(image.width, WIDTH);
        assert_int_equal(image.height, HEIGHT);
        for (size_t i = 0; i < WIDTH * HEIGHT * 3; i++) {
            float tolerance = full ? 0 : fmaxf(fabsf(values[i]) * 0x1p-11f, 0x1p-25f);
            if (fabsf(value_at(&image, i) - values[i]) > tolerance)
                fail_msg("sample %d is %a, not %a", (int)i, (double)value_at(&image, i), (double)values[i]);
        }
        image_free(&image);
        file_free(&file);
    }
    free(values);
}

/* Noise with more and more of it black: on the way from blocks that do not compress to those that do lie some that are
 * exactly as long as they would be raw. */
static void blocks_as_long_as_raw_come_back(void **state) {
    (void)state;
    enum { WIDTH = 24, HEIGHT = 16, COUNT = WIDTH * HEIGHT };
    for (uint32_t n = 0; n < 400; n++) {
        float values[COUNT];
        for (uint32_t i = 0; i < COUNT; i++)
            values[i] = i < n / 8 ? 0 : unit_float(hash32(COUNT * n + i)) + unit_float(hash32(~(COUNT * n + i))) * 0x1p-12f;
        const kiln_exr_channel channel = {"Y", values, 1, true};
        kiln_bytes file =
            write_exr(&(kiln_exr_file){.width = WIDTH, .height = HEIGHT, .channels = &channel, .channel_count = 1});
        kiln_image image = decode_well(file.data, file.size);
        for (size_t i = 0; i < COUNT; i++)
            if (value_at(&image, i) != values[i])
                fail_msg("picture %u: %a, not %a", n, (double)value_at(&image, i), (double)values[i]);
        image_free(&image);
        file_free(&file);
    }
}

static void a_crop_is_the_data_window(void **state) {
    (void)state;
    float values[2 * 3] = {1, 2, 3, 4, 5, 6};
    const kiln_exr_channel channel = {"Y", values, 1, true};
    kiln_bytes file = write_exr(
        &(kiln_exr_file){.width = 10, .height = 20, .crop = {4, 7, 6, 10}, .channels = &channel, .channel_count = 1});
    exr_context_t exr = open_exr(&file);
    exr_attr_box2i_t data, display;
    exr_get_data_window(exr, 0, &data);
    exr_get_display_window(exr, 0, &display);
    assert_true(data.min.x == 4 && data.min.y == 7 && data.max.x == 5 && data.max.y == 9);
    assert_true(display.min.x == 0 && display.min.y == 0 && display.max.x == 9 && display.max.y == 19);
    exr_finish(&exr);
    kiln_image image = decode_well(file.data, file.size);
    assert_true(value_at(&image, 7 * 10 + 4) == 1 && value_at(&image, 9 * 10 + 5) == 6 && value_at(&image, 0) == 0);
    image_free(&image);
    file_free(&file);
}

static void metadata_is_written(void **state) {
    (void)state;
    float value = 1;
    const kiln_exr_channel channels[] = {{"lightgroup:a_key_light_with_a_rather_long_name.R", &value, 1, false},
                                         {"Z", &value, 1, true},
                                         {"albedo.R", &value, 1, false}};
    const kiln_exr_attribute attributes[] = {{"comments", KILN_EXR_STRING, "gr\xc3\xbc\xc3\x9f", 0},
                                             {"kiln:spp", KILN_EXR_INT, NULL, 64},
                                             {"kiln:error", KILN_EXR_FLOAT, NULL, 0.25},
                                             {"kiln:seconds", KILN_EXR_DOUBLE, NULL, 1.0 / 3}};
    const float rec709[8] = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    kiln_bytes file = write_exr(&(kiln_exr_file){.width = 1,
                                                 .height = 1,
                                                 .channels = channels,
                                                 .channel_count = 3,
                                                 .attributes = attributes,
                                                 .attribute_count = 4,
                                                 .chromaticities = rec709});
    exr_context_t exr = open_exr(&file);
    const exr_attr_chlist_t *list;
    exr_attr_chromaticities_t xy;
    exr_compression_t compression;
    exr_storage_t storage;
    const char *text;
    int32_t length, whole;
    float single;
    double wide;
    assert_int_equal(exr_get_channels(exr, 0, &list), 0);
    assert_int_equal(list->num_channels, 3);
    assert_string_equal(list->entries[0].name.str, "Z");
    assert_int_equal(list->entries[0].pixel_type, EXR_PIXEL_FLOAT);
    assert_string_equal(list->entries[1].name.str, "albedo.R");
    assert_int_equal(list->entries[1].pixel_type, EXR_PIXEL_HALF);
    assert_string_equal(list->entries[2].name.str, channels[0].name);
    assert_int_equal(exr_get_compression(exr, 0, &compression) + exr_get_storage(exr, 0, &storage), 0);
    assert_true(compression == EXR_COMPRESSION_ZIP && storage == EXR_STORAGE_SCANLINE);
    assert_int_equal(exr_attr_get_string(exr, 0, "comments", &length, &text), 0);
    assert_string_equal(text, attributes[0].string);
    assert_int_equal(exr_attr_get_int(exr, 0, "kiln:spp", &whole) + exr_attr_get_float(exr, 0, "kiln:error", &single) +
                         exr_attr_get_double(exr, 0, "kiln:seconds", &wide),
                     0);
    assert_true(whole == 64 && single == 0.25f && wide == 1.0 / 3);
    assert_int_equal(exr_attr_get_chromaticities(exr, 0, "chromaticities", &xy), 0);
    assert_true(xy.red_x == 0.64f && xy.white_y == 0.329f && xy.blue_y == 0.06f);
    exr_finish(&exr);
    file_free(&file);
}

static void halves_are_clamped(void **state) {
    (void)state;
    float values[5] = {1e9f, -INFINITY, NAN, 65519.0f, 65504.0f};
    const kiln_exr_channel channel = {"Y", values, 1, false};
    kiln_bytes file = write_exr(&(kiln_exr_file){.width = 5, .height = 1, .channels = &channel, .channel_count = 1});
    kiln_image image = decode_well(file.data, file.size);
    const float want[5] = {65504, -65504, NAN, 65504, 65504};
    for (size_t i = 0; i < 5; i++)
        assert_true(value_at(&image, i) == want[i] || (i == 2 && value_at(&image, i) != value_at(&image, i)));
    image_free(&image);
    file_free(&file);
}

static void the_same_input_gives_the_same_bytes(void **state) {
    (void)state;
    enum { HEIGHT = 2001 }; /* several batches of blocks, and a block that is not full */
    float *values = noise(16 * HEIGHT);
    const kiln_exr_channel channel = {"Y", values, 1, false};
    kiln_exr_file picture = {.width = 16, .height = HEIGHT, .channels = &channel, .channel_count = 1, .threads = 1};
    kiln_bytes first = write_exr(&picture);
    const uint32_t threads[] = {1, 3, 100, 0};
    for (int i = 0; i < COUNT(threads); i++) {
        picture.threads = threads[i];
        kiln_bytes again = write_exr(&picture);
        assert_int_equal(first.size, again.size);
        assert_memory_equal(first.data, again.data, first.size);
        file_free(&again);
    }
    kiln_image image = decode_well(first.data, first.size);
    assert_float_equal(value_at(&image, 16 * HEIGHT - 1), values[16 * HEIGHT - 1], 0.05);
    image_free(&image);
    file_free(&first);
    free(values);
}

static void fails(const char *path, const kiln_exr_file *file) {
    kiln_report *report = kiln_report_create();
    assert_false(image_write_exr(path, file, report));
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 1);
    assert_true(strstr(kiln_report_message(report, 0).where, "a.exr") != NULL);
    kiln_report_destroy(report);
}

static void failures_leave_nothing_behind(void **state) {
    (void)state;
    float value = 1;
    const kiln_exr_channel same[2] = {{"Y", &value, 1, false}, {"Y", &value, 1, false}},
                           unnamed = {"", &value, 1, false};
    const kiln_exr_attribute unnamed_attribute = {"", KILN_EXR_INT, NULL, 0},
                             kind = {"channels", KILN_EXR_INT, NULL, 0};
    kiln_exr_file good = {.width = 1, .height = 1, .channels = same, .channel_count = 1}, f;
    folder there = folder_make("a.exr");
    fails("/nonexistent/a.exr", &good);
    f = good, f.channel_count = 2;
    fails(there.file, &f);
    f = good, f.channel_count = 0;
    fails(there.file, &f);
    f = good, f.width = 0;
    fails(there.file, &f);
    f = good, f.crop[2] = 2, f.crop[3] = 1;
    fails(there.file, &f);
    f = good, f.channels = &unnamed;
    fails(there.file, &f);
    f = good, f.attributes = &unnamed_attribute, f.attribute_count = 1;
    fails(there.file, &f);
    f = good, f.attributes = &kind, f.attribute_count = 1;
    fails(there.file, &f);
    folder_remove(&there);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_come_back),
        cmocka_unit_test(blocks_as_long_as_raw_come_back),
        cmocka_unit_test(a_crop_is_the_data_window),
        cmocka_unit_test(metadata_is_written),
        cmocka_unit_test(halves_are_clamped),
        cmocka_unit_test(the_same_input_gives_the_same_bytes),
        cmocka_unit_test(failures_leave_nothing_behind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
