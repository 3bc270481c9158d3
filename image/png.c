#include <png.h>

#include <setjmp.h>
#include <string.h>

#include "base/file.h"
#include "image/codec.h"
#include "image/icc.h"

/* libpng's errors arrive here and leave by longjmp. Everything that lives across the jump is in this struct. */
typedef struct guard {
    jmp_buf jump;
    char message[160];
    bool file_failed; /* it is too short, or cannot be written */
} guard;

static void on_error(png_structp png, png_const_charp message) {
    guard *g = png_get_error_ptr(png);
    snprintf(g->message, sizeof g->message, "%s", message);
    longjmp(g->jump, 1);
}

static void on_warning(png_structp png, png_const_charp message) {
    (void)png;
    (void)message; /* about chunks that are not used */
}

typedef struct reader {
    guard guard;
    const image_source *source;
    kiln_image_info *info;
    kiln_image *image;
    png_structp png;
    png_infop png_info;
    size_t at;
} reader;

static void read_bytes(png_structp png, png_bytep to, size_t count) {
    reader *r = png_get_io_ptr(png);
    if (count > r->source->size - r->at) {
        r->guard.file_failed = true;
        png_error(png, "the file ends too early");
    }
    memcpy(to, r->source->bytes + r->at, count);
    r->at += count;
}

/* All forms become 8 or 16 bits of grey, grey + alpha, RGB or RGBA. gAMA, cHRM, sRGB and iCCP are left alone: glTF 2.0
 * (Images) says that a client must ignore them, and the scene states each texture's encoding by its use. */
static bool read_header(reader *r) {
    png_structp png = r->png;
    png_set_read_fn(png, r, read_bytes);
    /* image_check_size does this; ancillary chunks, some of them compressed, are skipped unread. */
    png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
    png_set_chunk_malloc_max(png, 1 << 24);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_read_info(png, r->png_info);
    r->info->width = png_get_image_width(png, r->png_info);
    r->info->height = png_get_image_height(png, r->png_info);
    if (!image_check_size(r->source, r->info)) return false; /* before libpng allocates rows */
    png_byte type = png_get_color_type(png, r->png_info);
    if (type == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
    if (type == PNG_COLOR_TYPE_GRAY) png_set_expand_gray_1_2_4_to_8(png);
    if (png_get_valid(png, r->png_info, PNG_INFO_tRNS)) png_set_tRNS_to_alpha(png);
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    png_set_swap(png);
#endif
    (void)png_set_interlace_handling(png);
    png_read_update_info(png, r->png_info);
    r->info->channels = png_get_channels(png, r->png_info);
    r->info->format = png_get_bit_depth(png, r->png_info) == 16 ? KILN_PIXELS_U16 : KILN_PIXELS_U8;
    return true;
}

static void read_rows(reader *r) {
    size_t stride = png_get_rowbytes(r->png, r->png_info);
    int passes = png_get_interlace_type(r->png, r->png_info) == PNG_INTERLACE_ADAM7 ? 7 : 1;
    for (int pass = 0; pass < passes; pass++)
        for (uint32_t y = 0; y < r->image->height; y++)
            png_read_row(r->png, (png_bytep)r->image->pixels + y * stride, NULL);
}

static bool read_guarded(reader *r) {
    if (setjmp(r->guard.jump))
        return r->guard.file_failed ? image_truncated(r->source, "PNG")
                                    : image_damaged(r->source, "PNG", r->guard.message);
    if (!read_header(r)) return false;
    if (!r->image) return true;
    if (!image_prepare(r->source, r->info, r->image)) return false;
    read_rows(r);
    return true;
}

bool image_read_png(const image_source *source, kiln_image_info *info, kiln_image *image) {
    reader r = {.source = source, .info = info, .image = image};
    r.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &r.guard, on_error, on_warning);
    r.png_info = r.png ? png_create_info_struct(r.png) : NULL;
    bool done = r.png_info ? read_guarded(&r) : report_no_memory(source->report, "reading a PNG image");
    png_destroy_read_struct(&r.png, &r.png_info, NULL);
    return done;
}

typedef struct writer {
    guard guard;
    const image_samples *samples;
    unsigned char profile[IMAGE_ICC_MAX];
    kiln_writer *file;
    png_structp png;
    png_infop png_info;
} writer;

static void write_bytes(png_structp png, png_bytep data, size_t count) {
    writer *w = png_get_io_ptr(png);
    if (file_write(w->file, data, count)) return;
    w->guard.file_failed = true;
    png_error(png, "the file cannot be written");
}

static void flush(png_structp png) { (void)png; }

/* Coding-independent code points (PNG, third edition, 11.3.2.6): primaries, transfer, matrix (0: RGB), full range. */
static void set_code_points(writer *w) {
    uint8_t points[4] = {0, 0, 0, 1};
    image_code_points(w->samples->options, points);
    if (!points[0]) return;
#ifdef PNG_cICP_SUPPORTED
    png_set_cICP(w->png, w->png_info, points[0], points[1], points[2], points[3]);
#else
    png_unknown_chunk chunk = {.name = "cICP", .data = points, .size = sizeof points, .location = PNG_HAVE_IHDR};
    png_set_keep_unknown_chunks(w->png, PNG_HANDLE_CHUNK_ALWAYS, (png_const_bytep) "cICP", 1);
    png_set_unknown_chunks(w->png, w->png_info, &chunk, 1);
#endif
}

/* Readers older than cICP know sRGB, or a profile; a file has one of them. */
static void set_profile(writer *w) {
    const image_samples *s = w->samples;
    if (s->options->srgb) {
        png_set_sRGB(w->png, w->png_info, PNG_sRGB_INTENT_RELATIVE);
        return;
    }
    size_t size = s->channels >= 3 ? image_icc(s->options, w->profile) : 0;
    if (size)
        png_set_iCCP(w->png, w->png_info, "display", PNG_COMPRESSION_TYPE_BASE, w->profile, (png_uint_32)size);
}

static bool is_ascii(const char *text) {
    for (; *text; text++)
        if ((unsigned char)*text > 126) return false;
    return true;
}

/* tEXt is Latin-1, so anything beyond ASCII goes as iTXt in UTF-8. */
static void set_text(writer *w) {
    const kiln_image_write_options *options = w->samples->options;
    for (uint32_t i = 0; i < options->text_count; i++) {
        const char *value = options->text[2 * i + 1];
        png_text text = {.compression = is_ascii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE,
                         .key = (png_charp)(uintptr_t)options->text[2 * i],
                         .text = (png_charp)(uintptr_t)value};
        png_set_text(w->png, w->png_info, &text, 1);
    }
}

static bool write_guarded(writer *w) {
    static const int types[] = {0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                PNG_COLOR_TYPE_RGB_ALPHA};
    const image_samples *s = w->samples;
    if (setjmp(w->guard.jump)) return false;
    png_set_write_fn(w->png, w, write_bytes, flush);
    png_set_IHDR(w->png, w->png_info, s->width, s->height, (int)s->bits, types[s->channels], PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    set_profile(w);
    set_code_points(w);
    set_text(w);
    png_write_info(w->png, w->png_info);
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    if (s->bits == 16) png_set_swap(w->png);
#endif
    for (uint32_t y = 0; y < s->height; y++) png_write_row(w->png, s->bytes + y * image_samples_row(s));
    png_write_end(w->png, w->png_info);
    return true;
}

bool image_write_png(const image_samples *samples) {
    writer w = {.samples = samples, .file = file_create(samples->path, samples->report)};
    if (!w.file) return false;
    w.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &w.guard, on_error, on_warning);
    w.png_info = w.png ? png_create_info_struct(w.png) : NULL;
    bool written = w.png_info && write_guarded(&w);
    png_destroy_write_struct(&w.png, &w.png_info);
    if (written || w.guard.file_failed) return file_commit(w.file, samples->report);
    file_discard(w.file);
    return image_not_written(samples->path, samples->report, "%s", w.guard.message);
}
