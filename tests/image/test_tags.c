/* What files say about themselves: the colours of their numbers, and who made them how. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <png.h>

#include "image/icc.h"
#include "support.h"

typedef struct display {
    const char *name;
    kiln_image_write_options options;
    double xy[6], gamma;
} display;

static const display displays[] = {
    {"sRGB", {.srgb = true}, {0.64, 0.33, 0.30, 0.60, 0.15, 0.06}, 0},
    {"Display P3", {.cicp_primaries = 12, .cicp_transfer = 13}, {0.68, 0.32, 0.265, 0.69, 0.15, 0.06}, 0},
    {"Rec.1886", {.cicp_primaries = 1, .cicp_transfer = 1}, {0.64, 0.33, 0.30, 0.60, 0.15, 0.06}, 2.4},
};

static uint32_t read32(const unsigned char *p) {
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}
static double read_real(const unsigned char *p) { return (double)(int32_t)read32(p) / 65536; }

/* ICC.1:2010, 7.3: signature, offset, size. */
static const unsigned char *find_tag(const unsigned char *profile, const char *name) {
    for (uint32_t i = 0; i < read32(profile + 128); i++)
        if (memcmp(profile + 132 + 12 * i, name, 4) == 0) return profile + read32(profile + 132 + 12 * i + 4);
    fail_msg("no tag %s", name);
    return NULL;
}

/* A colorant, taken back to D65 by the inverse of Bradford's matrix as chad has it, lies on its primary's xy. */
static void check_primary(const unsigned char *profile, const char *tag, const double xy[2]) {
    static const double back[9] = {0.9555766, -0.0230393, 0.0631636, -0.0282895, 1.0099416,
                                   0.0210077, 0.0122982,  -0.0204830, 1.3299098};
    double c[3], d[3];
    for (int k = 0; k < 3; k++) c[k] = read_real(find_tag(profile, tag) + 8 + 4 * k);
    for (int k = 0; k < 3; k++) d[k] = back[3 * k] * c[0] + back[3 * k + 1] * c[1] + back[3 * k + 2] * c[2];
    double sum = d[0] + d[1] + d[2];
    assert_true(fabs(d[0] / sum - xy[0]) < 2e-4 && fabs(d[1] / sum - xy[1]) < 2e-4);
}

static void profiles_have_the_displays_primaries_and_curve(void **state) {
    (void)state;
    static const char *const colorants[] = {"rXYZ", "gXYZ", "bXYZ"};
    static const double d50[3] = {0.9642, 1, 0.8249};
    for (int i = 0; i < COUNT(displays); i++) {
        unsigned char profile[IMAGE_ICC_MAX];
        size_t size = image_icc(&displays[i].options, profile);
        assert_true(size > 128 && size == read32(profile));
        double sum[3] = {0};
        for (int k = 0; k < 3; k++) {
            check_primary(profile, colorants[k], displays[i].xy + 2 * k);
            for (int j = 0; j < 3; j++) sum[j] += read_real(find_tag(profile, colorants[k]) + 8 + 4 * j);
        }
        for (int j = 0; j < 3; j++) assert_true(fabs(sum[j] - d50[j]) < 3e-4);
        const unsigned char *curve = find_tag(profile, "gTRC");
        assert_memory_equal(curve, "para", 4);
        assert_int_equal(curve[9], displays[i].gamma > 0 ? 0 : 3);
        assert_true(fabs(read_real(curve + 12) - 2.4) < 1e-4);
    }
}

static void what_is_not_known_gets_no_profile(void **state) {
    (void)state;
    unsigned char profile[IMAGE_ICC_MAX];
    assert_int_equal(image_icc(&(kiln_image_write_options){0}, profile), 0);
    assert_int_equal(image_icc(&(kiln_image_write_options){.cicp_primaries = 9, .cicp_transfer = 16}, profile), 0);
}

static bool holds(const kiln_bytes *file, const void *part, size_t size) {
    return memmem(file->data, file->size, part, size) != NULL;
}

/* As libpng reads it, which checks it. */
static void check_png(const kiln_bytes *file, const unsigned char *profile, size_t size) {
    folder f = folder_make("a.png");
    kiln_report *report = kiln_report_create();
    assert_true(file_replace(f.file, file->data, file->size, report));
    kiln_report_destroy(report);
    FILE *in = fopen(f.file, "rb");
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_charp name;
    png_bytep found;
    png_uint_32 length;
    int compression;
    png_init_io(png, in);
    png_read_info(png, info);
    assert_int_equal(png_get_iCCP(png, info, &name, &compression, &found, &length), PNG_INFO_iCCP);
    assert_int_equal(length, size);
    assert_memory_equal(found, profile, size);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(in);
    folder_remove(&f);
}

static void every_format_has_the_profile(void **state) {
    (void)state;
    kiln_image image = smooth(8, 8, 3);
    for (int i = 0; i < COUNT(displays); i++) {
        unsigned char profile[IMAGE_ICC_MAX];
        size_t size = image_icc(&displays[i].options, profile);
        static const char *const names[] = {"a.jpg", "a.webp", "a.tif", "a.png"};
        for (int n = 0; n < COUNT(names); n++) {
            kiln_bytes file = encode_display(names[n], &image, displays[i].options);
            if (n < 3) {
                if (!holds(&file, profile, size)) fail_msg("%s: no profile for %s", names[n], displays[i].name);
            } else if (displays[i].options.srgb) assert_false(holds(&file, "iCCP", 4)); /* it has sRGB instead */
            else check_png(&file, profile, size);
            file_free(&file);
        }
    }
    image_free(&image);
}

static const char *const text[] = {"Software", "kiln 1", "Color view", "a <b> & \"c\"\x01"};

static void jpeg_and_webp_have_the_text_as_xmp(void **state) {
    (void)state;
    static const char tool[] = "xmp:CreatorTool=\"kiln 1\"",
                      lines[] = ">Software: kiln 1\nColor view: a &lt;b&gt; &amp; &quot;c&quot; </rdf:li>";
    kiln_image image = smooth(8, 8, 3);
    const char *const names[] = {"a.jpg", "a.webp"};
    for (int n = 0; n < COUNT(names); n++) {
        kiln_bytes file = encode_display(names[n], &image, (kiln_image_write_options){.text = text, .text_count = 2});
        assert_true(holds(&file, tool, sizeof tool - 1));
        assert_true(holds(&file, lines, sizeof lines - 1));
        kiln_image back = decode_well(file.data, file.size);
        same_picture(&back, &image, 255, 16);
        image_free(&back);
        file_free(&file);
    }
    image_free(&image);
}

/* A marker holds 64 kB. */
static void a_text_that_no_jpeg_holds_is_left_out(void **state) {
    (void)state;
    enum { LENGTH = 70000 };
    char *value = malloc(LENGTH + 1);
    memset(value, 'x', LENGTH);
    value[LENGTH] = '\0';
    const char *const pair[] = {"Software", value};
    kiln_image image = smooth(8, 8, 3);
    kiln_bytes file = encode_display("a.jpg", &image, (kiln_image_write_options){.text = pair, .text_count = 1});
    assert_true(file.size < LENGTH);
    file_free(&file);
    image_free(&image);
    free(value);
}

static void radiance_has_the_text_in_its_header(void **state) {
    (void)state;
    static const char header[] =
        "#?RADIANCE\nSOFTWARE=kiln 1\n# Color view: a <b> & \"c\" \nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n";
    kiln_image image = smooth(8, 4, 3);
    folder f = folder_make("a.hdr");
    kiln_report *report = kiln_report_create();
    assert_true(image_write_hdr(f.file, &image, text, 2, report));
    kiln_report_destroy(report);
    kiln_bytes file = read_whole(f.file);
    assert_memory_equal(file.data, header, sizeof header - 1);
    kiln_image back = decode_well(file.data, file.size);
    same_picture(&back, &image, 1, 0.01f);
    image_free(&back);
    image_free(&image);
    file_free(&file);
    folder_remove(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(profiles_have_the_displays_primaries_and_curve),
        cmocka_unit_test(what_is_not_known_gets_no_profile),
        cmocka_unit_test(every_format_has_the_profile),
        cmocka_unit_test(jpeg_and_webp_have_the_text_as_xmp),
        cmocka_unit_test(a_text_that_no_jpeg_holds_is_left_out),
        cmocka_unit_test(radiance_has_the_text_in_its_header),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
