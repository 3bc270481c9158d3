#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/file.h"
#include "base/text.h"
#include "image/codec.h"

/* Radiance's picture format: Ward, "Real Pixels", Graphics Gems II (1991), and the Radiance file formats document. A
 * pixel is three mantissas of 8 bits and one exponent: value = mantissa · 2^(exponent − 136), zero when the exponent
 * is 0. */

typedef struct reader {
    const image_source *source;
    size_t at;
    float scale[3]; /* what undoes EXPOSURE and COLORCORR */
    /* The file's rows go along one axis, its columns along the other. */
    bool rows_are_x, x_down, y_down; /* x runs right to left; y runs from the top, as in "-Y" */
    uint32_t rows, columns;
} reader;

static bool damaged(const reader *r, const char *why) { return image_damaged(r->source, "Radiance HDR", why); }
static bool truncated(const reader *r) { return image_truncated(r->source, "Radiance HDR"); }

/* One line without its end; longer ones than any that matters are cut. False at the end of the file. */
static bool next_line(reader *r, char line[256]) {
    const unsigned char *bytes = r->source->bytes;
    size_t length = 0, start = r->at;
    while (r->at < r->source->size && bytes[r->at] != '\n') r->at++;
    if (r->at == r->source->size) return false;
    for (size_t i = start; i < r->at && length < 255; i++) line[length++] = (char)bytes[i];
    if (length && line[length - 1] == '\r') length--;
    line[length] = '\0';
    r->at++;
    return true;
}

/* count numbers separated by blanks, all above 0. */
static bool read_factors(const char *text, int count, double *factors) {
    for (int i = 0; i < count; i++) {
        char word[64];
        text += strspn(text, " \t");
        size_t length = strcspn(text, " \t");
        if (length >= sizeof word) return false;
        memcpy(word, text, length);
        word[length] = '\0';
        if (!text_to_double(word, &factors[i]) || !(factors[i] > 0)) return false;
        text += length;
    }
    return true;
}

/* EXPOSURE and COLORCORR say by what the radiance was multiplied; there may be several of each. */
static bool read_variable(reader *r, const char *line) {
    double f[3];
    if (strncmp(line, "EXPOSURE=", 9) == 0) {
        if (!read_factors(line + 9, 1, f)) return damaged(r, "EXPOSURE is not a positive number");
        for (int c = 0; c < 3; c++) r->scale[c] = (float)((double)r->scale[c] / f[0]);
    } else if (strncmp(line, "COLORCORR=", 10) == 0) {
        if (!read_factors(line + 10, 3, f)) return damaged(r, "COLORCORR is not three positive numbers");
        for (int c = 0; c < 3; c++) r->scale[c] = (float)((double)r->scale[c] / f[c]);
    } else if (strncmp(line, "FORMAT=", 7) == 0 && strcmp(line + 7, "32-bit_rle_rgbe") != 0) {
        return image_refuse(r->source, KILN_CODE_IMAGE, "convert it with Radiance's `ra_xyze -r`",
                            "Radiance pictures of format %s cannot be read", line + 7);
    }
    return true;
}

static bool read_side(const char **text, char *sign, char *axis, uint32_t *count) {
    char *end;
    if ((**text != '-' && **text != '+') || ((*text)[1] != 'X' && (*text)[1] != 'Y') || (*text)[2] != ' ') return false;
    *sign = (*text)[0];
    *axis = (*text)[1];
    *text += 3 + strspn(*text + 3, " ");
    if (**text < '0' || **text > '9') return false;
    unsigned long value = strtoul(*text, &end, 10);
    *count = value > UINT32_MAX ? UINT32_MAX : (uint32_t)value;
    *text = end + strspn(end, " ");
    return true;
}

/* "-Y 512 +X 1024": rows from the top, columns from the left; signs and axes may be any. */
static bool read_resolution(reader *r, const char *line) {
    char signs[2], axes[2];
    if (!read_side(&line, &signs[0], &axes[0], &r->rows) || !read_side(&line, &signs[1], &axes[1], &r->columns) ||
        *line || axes[0] == axes[1])
        return damaged(r, "the line of its size is not of the form -Y N +X M");
    r->rows_are_x = axes[0] == 'X';
    r->x_down = signs[!r->rows_are_x] == '-';
    r->y_down = signs[r->rows_are_x] == '-';
    return true;
}

static bool read_header(reader *r, kiln_image_info *info) {
    char line[256];
    do {
        if (!next_line(r, line)) return truncated(r);
        if (!read_variable(r, line)) return false;
    } while (line[0]);
    if (!next_line(r, line)) return truncated(r);
    if (!read_resolution(r, line)) return false;
    info->width = r->rows_are_x ? r->rows : r->columns;
    info->height = r->rows_are_x ? r->columns : r->rows;
    info->channels = 3;
    info->format = KILN_PIXELS_F32;
    return true;
}

/* The newer run-length code: the four components one after the other; a count above 128 repeats the next byte. */
static bool read_component(reader *r, unsigned char *row, uint32_t count) {
    const unsigned char *bytes = r->source->bytes;
    for (uint32_t x = 0; x < count;) {
        size_t left = r->source->size - r->at;
        if (left < 2) return truncated(r);
        uint32_t run = bytes[r->at++];
        bool repeat = run > 128;
        if (repeat) run -= 128;
        if (!run || run > count - x) return damaged(r, "a run is longer than its row");
        if (!repeat && left - 1 < run) return truncated(r);
        for (uint32_t i = 0; i < run; i++) row[4 * (x + i)] = bytes[r->at + (repeat ? 0 : i)];
        r->at += repeat ? 1 : run;
        x += run;
    }
    return true;
}

/* Plain pixels, among which the older code's 1 1 1 N repeats the last one N times; consecutive ones are digits of a
 * count in base 256, the lowest first. */
static bool read_old_row(reader *r, unsigned char *row) {
    unsigned shift = 0;
    for (uint32_t x = 0; x < r->columns;) {
        if (r->source->size - r->at < 4) return truncated(r);
        const unsigned char *pixel = r->source->bytes + r->at;
        r->at += 4;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            memcpy(row + 4 * (size_t)x++, pixel, 4);
            shift = 0;
            continue;
        }
        uint64_t run = shift < 32 ? (uint64_t)pixel[3] << shift : UINT64_MAX;
        if (run > r->columns - x || !x) return damaged(r, "a run is longer than its row, or repeats nothing");
        for (uint64_t i = 0; i < run; i++, x++) memcpy(row + 4 * (size_t)x, row + 4 * (size_t)(x - 1), 4);
        shift += 8;
    }
    return true;
}

static bool read_row(reader *r, unsigned char *row) {
    const unsigned char *lead = r->source->bytes + r->at;
    bool newer = r->columns >= 8 && r->columns <= 32767 && r->source->size - r->at >= 4 && lead[0] == 2 &&
                 lead[1] == 2 && ((uint32_t)lead[2] << 8 | lead[3]) == r->columns;
    if (!newer) return read_old_row(r, row);
    r->at += 4;
    for (size_t c = 0; c < 4; c++)
        if (!read_component(r, row + c, r->columns)) return false;
    return true;
}

static void put_row(const reader *r, const unsigned char *row, uint32_t index, kiln_image *image) {
    for (uint32_t i = 0; i < r->columns; i++, row += 4) {
        uint32_t x = r->rows_are_x ? index : i, y = r->rows_are_x ? i : index;
        if (r->x_down) x = image->width - 1 - x;
        if (!r->y_down) y = image->height - 1 - y;
        float *to = (float *)image->pixels + 3 * ((size_t)y * image->width + x);
        float unit = row[3] ? ldexpf(1.0f, (int)row[3] - 136) : 0.0f;
        for (int c = 0; c < 3; c++) to[c] = (float)row[c] * unit * r->scale[c];
    }
}

bool image_read_hdr(const image_source *source, kiln_image_info *info, kiln_image *image) {
    reader r = {.source = source, .scale = {1, 1, 1}};
    if (!read_header(&r, info)) return false;
    if (!image) return true;
    if (!image_prepare(source, info, image)) return false;
    unsigned char *row = array_alloc(r.columns, 4);
    if (!row) return report_no_memory(source->report, "reading a Radiance HDR image");
    bool done = true;
    for (uint32_t i = 0; done && i < r.rows; i++) {
        done = read_row(&r, row);
        if (done) put_row(&r, row, i, image);
    }
    free(row);
    return done;
}

/* Rounded to the nearest mantissa, the largest of which is then in 128 … 255. Negative and NaN become 0; beyond the
 * largest exponent, the largest value. */
static void encode_pixel(const float *rgb, unsigned char rgbe[4]) {
    float largest = 0;
    for (int c = 0; c < 3; c++) largest = rgb[c] > largest ? rgb[c] : largest;
    memset(rgbe, 0, 4);
    if (largest < 1e-38f) return;
    int exponent;
    (void)frexpf(largest < 0x1p126f ? largest : 0x1p126f, &exponent);
    float scale = ldexpf(1.0f, 8 - exponent);
    if (largest * scale >= 255.5f && exponent < 127) {
        exponent++;
        scale *= 0.5f;
    }
    for (int c = 0; c < 3; c++) {
        float mantissa = rgb[c] * scale + 0.5f;
        rgbe[c] = mantissa >= 255 ? 255 : mantissa > 0 ? (unsigned char)mantissa : 0;
    }
    rgbe[3] = (unsigned char)(exponent + 128);
}

/* Runs of at least four equal bytes are coded as such. */
static void encode_component(kiln_text *out, const unsigned char *row, uint32_t count) {
    for (uint32_t x = 0; x < count;) {
        uint32_t start = x, run = 0;
        while (start < count) {
            for (run = 1; run < 127 && start + run < count && row[4 * (start + run)] == row[4 * start];) run++;
            if (run >= 4) break;
            start += run;
        }
        while (x < start) {
            uint32_t plain = start - x < 128 ? start - x : 128;
            text_append_bytes(out, &(char){(char)plain}, 1);
            for (uint32_t i = 0; i < plain; i++, x++) text_append_bytes(out, (const char *)row + 4 * x, 1);
        }
        if (start < count) {
            text_append_bytes(out, &(char){(char)(128 + run)}, 1);
            text_append_bytes(out, (const char *)row + 4 * start, 1);
            x += run;
        }
    }
}

static void encode_row(kiln_text *out, const float *pixels, uint32_t width, unsigned char *row) {
    for (uint32_t x = 0; x < width; x++) encode_pixel(pixels + 3 * (size_t)x, row + 4 * (size_t)x);
    if (width < 8 || width > 32767) { /* the run-length code does not reach them */
        text_append_bytes(out, (const char *)row, 4 * (size_t)width);
        return;
    }
    unsigned char lead[4] = {2, 2, (unsigned char)(width >> 8), (unsigned char)width};
    text_append_bytes(out, (const char *)lead, 4);
    for (size_t c = 0; c < 4; c++) encode_component(out, row + c, width);
}

static void append_line(kiln_text *out, const char *before, const char *separator, const char *value) {
    text_format(out, "%s%s", before, separator);
    for (; *value; value++) text_append_bytes(out, (unsigned char)*value < 0x20 ? " " : value, 1);
    text_append(out, "\n");
}

/* SOFTWARE is Radiance's own variable; the rest are comments. */
static void append_text(kiln_text *out, const char *const *text, uint32_t count) {
    for (uint32_t i = 0; i < count; i++, text += 2) {
        bool software = strcmp(text[0], "Software") == 0;
        if (!software) text_append(out, "# ");
        append_line(out, software ? "SOFTWARE" : text[0], software ? "=" : ": ", text[1]);
    }
}

bool image_write_hdr(const char *path, const kiln_image *image, const char *const *text, uint32_t text_count,
                     kiln_report *report) {
    kiln_where here = where_root(path);
    if (image->format != KILN_PIXELS_F32 || image->channels != 3 || !image->width || !image->height)
        return report_error(report, KILN_CODE_INTERNAL, &here, NULL, "a Radiance picture needs RGB of 32-bit floats");
    kiln_text out = {0};
    unsigned char *row = array_alloc(image->width, 4);
    text_append(&out, "#?RADIANCE\n");
    append_text(&out, text, text_count);
    text_format(&out, "FORMAT=32-bit_rle_rgbe\n\n-Y %u +X %u\n", image->height, image->width);
    for (uint32_t y = 0; row && y < image->height; y++)
        encode_row(&out, (const float *)image->pixels + 3 * (size_t)y * image->width, image->width, row);
    bool done = row && !out.failed ? file_replace(path, out.data, out.length, report)
                                   : report_no_memory(report, "writing a Radiance HDR picture");
    free(row);
    text_free(&out);
    return done;
}
