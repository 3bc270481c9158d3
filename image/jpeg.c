#include <stdio.h>

#include <jpeglib.h>

#include <jerror.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/file.h"
#include "image/codec.h"
#include "image/icc.h"

/* libjpeg's errors arrive here and leave by longjmp. Everything that lives across the jump is in a struct. */
typedef struct guard {
    struct jpeg_error_mgr manager; /* first: libjpeg hands back a pointer to it */
    jmp_buf jump;
    char message[JMSG_LENGTH_MAX];
    bool truncated;
    bool damaged; /* decoding went on, but the picture is not what was encoded */
} guard;

static void on_error(j_common_ptr common) {
    guard *g = (guard *)common->err;
    g->manager.format_message(common, g->message);
    longjmp(g->jump, 1);
}

static void on_message(j_common_ptr common, int level) {
    guard *g = (guard *)common->err;
    if (level >= 0) return;
    if (g->manager.msg_code == JWRN_JPEG_EOF) {
        g->truncated = true;
        on_error(common);
    }
    if (!g->damaged) g->manager.format_message(common, g->message);
    g->damaged = true;
}

static void on_output(j_common_ptr common) { (void)common; }

static void guard_init(guard *g) {
    (void)jpeg_std_error(&g->manager);
    g->manager.error_exit = on_error;
    g->manager.emit_message = on_message;
    g->manager.output_message = on_output;
}

typedef struct reader {
    guard guard;
    struct jpeg_decompress_struct jpeg;
    struct jpeg_progress_mgr progress;
    const image_source *source;
    kiln_image_info *info;
    kiln_image *image;
    unsigned char *row; /* of CMYK */
} reader;

/* A progressive file of a few kilobytes may hold thousands of scans, each of which goes over the whole image. Encoders
 * write about ten. */
enum { SCANS_MAX = 200 };

static void on_progress(j_common_ptr common) {
    reader *r = (reader *)((char *)common->err - offsetof(reader, guard));
    if (r->jpeg.input_scan_number <= SCANS_MAX) return;
    snprintf(r->guard.message, sizeof r->guard.message, "more than %d scans", SCANS_MAX);
    longjmp(r->guard.jump, 1);
}

static void read_header(reader *r) {
    struct jpeg_decompress_struct *jpeg = &r->jpeg;
    jpeg_create_decompress(jpeg);
    jpeg->mem->max_memory_to_use = (long)r->source->limit;
    r->progress.progress_monitor = on_progress;
    jpeg->progress = &r->progress;
    jpeg_mem_src(jpeg, r->source->bytes, r->source->size);
    (void)jpeg_read_header(jpeg, TRUE);
    bool four = jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK;
    if (jpeg->jpeg_color_space != JCS_GRAYSCALE) jpeg->out_color_space = four ? JCS_CMYK : JCS_RGB;
    jpeg->dct_method = JDCT_ISLOW;
    r->info->width = jpeg->image_width;
    r->info->height = jpeg->image_height;
    r->info->channels = jpeg->jpeg_color_space == JCS_GRAYSCALE ? 1 : 3;
    r->info->format = KILN_PIXELS_U8;
}

/* Ink to light without a profile: each ink takes its share of what black leaves. Adobe stores ink inverted, and nearly
 * every CMYK JPEG is Adobe's. */
static void cmyk_to_rgb(const unsigned char *cmyk, unsigned char *rgb, uint32_t count, bool inverted) {
    for (uint32_t i = 0; i < count; i++, cmyk += 4, rgb += 3)
        for (int c = 0; c < 3; c++) {
            unsigned light = inverted ? cmyk[c] : 255u - cmyk[c], paper = inverted ? cmyk[3] : 255u - cmyk[3];
            rgb[c] = (unsigned char)((light * paper + 127) / 255);
        }
}

static void read_rows(reader *r) {
    struct jpeg_decompress_struct *jpeg = &r->jpeg;
    size_t stride = (size_t)r->image->width * r->image->channels;
    (void)jpeg_start_decompress(jpeg);
    if (jpeg->out_color_space == JCS_CMYK)
        r->row = jpeg->mem->alloc_large((j_common_ptr)jpeg, JPOOL_IMAGE, (size_t)jpeg->output_width * 4);
    while (jpeg->output_scanline < jpeg->output_height) {
        unsigned char *to = (unsigned char *)r->image->pixels + jpeg->output_scanline * stride;
        JSAMPROW row = r->row ? r->row : to;
        (void)jpeg_read_scanlines(jpeg, &row, 1);
        if (r->row) cmyk_to_rgb(r->row, to, r->image->width, jpeg->saw_Adobe_marker);
    }
}

static bool read_guarded(reader *r) {
    if (setjmp(r->guard.jump))
        return r->guard.truncated ? image_truncated(r->source, "JPEG")
                                  : image_damaged(r->source, "JPEG", r->guard.message);
    read_header(r);
    if (!r->image) return true;
    if (!image_prepare(r->source, r->info, r->image)) return false;
    read_rows(r);
    return true;
}

/* An orientation in Exif is not applied: glTF 2.0 (Images) says so. */
bool image_read_jpeg(const image_source *source, kiln_image_info *info, kiln_image *image) {
    reader r = {.source = source, .info = info, .image = image};
    guard_init(&r.guard);
    r.jpeg.err = &r.guard.manager;
    bool done = read_guarded(&r);
    jpeg_destroy_decompress(&r.jpeg);
    if (done && r.guard.damaged)
        report_warning(source->report, KILN_CODE_IMAGE, source->where, "export the image again",
                       "the JPEG data is damaged, the image may show it: %s", r.guard.message);
    return done;
}

typedef struct writer {
    guard guard;
    struct jpeg_compress_struct jpeg;
    unsigned char *bytes; /* libjpeg's malloc */
    unsigned long size;
    unsigned char profile[IMAGE_ICC_MAX];
    kiln_text xmp; /* with what goes before it in its marker */
} writer;

/* XMP specification, part 3, 1.1.3: a packet of more than one marker would have to be split; ours is left out. */
enum { MARKER_MAX = 65533 };

static bool write_guarded(writer *w, const image_samples *s) {
    struct jpeg_compress_struct *jpeg = &w->jpeg;
    if (setjmp(w->guard.jump)) return false;
    jpeg_create_compress(jpeg);
    jpeg_mem_dest(jpeg, &w->bytes, &w->size);
    jpeg->image_width = s->width;
    jpeg->image_height = s->height;
    jpeg->input_components = (int)s->channels;
    jpeg->in_color_space = s->channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(jpeg);
    int quality = s->options->quality ? (int)s->options->quality : 95;
    jpeg_set_quality(jpeg, quality, TRUE);
    /* Colour at half the resolution is for small files; who asks for quality gets all of it. */
    if (quality >= 90 && s->channels == 3) jpeg->comp_info[0].h_samp_factor = jpeg->comp_info[0].v_samp_factor = 1;
    jpeg->optimize_coding = TRUE;
    jpeg->dct_method = JDCT_ISLOW;
    jpeg_start_compress(jpeg, TRUE);
    unsigned profile = s->channels == 3 ? (unsigned)image_icc(s->options, w->profile) : 0;
    if (w->xmp.data && w->xmp.length <= MARKER_MAX)
        jpeg_write_marker(jpeg, JPEG_APP0 + 1, (const JOCTET *)w->xmp.data, (unsigned)w->xmp.length);
    if (profile) jpeg_write_icc_profile(jpeg, w->profile, profile);
    while (jpeg->next_scanline < jpeg->image_height) {
        JSAMPROW row = (JSAMPROW)(uintptr_t)(s->bytes + jpeg->next_scanline * image_samples_row(s));
        (void)jpeg_write_scanlines(jpeg, &row, 1);
    }
    jpeg_finish_compress(jpeg);
    return true;
}

bool image_write_jpeg(const image_samples *samples) {
    if (samples->channels == 2 || samples->channels == 4)
        return image_not_written(samples->path, samples->report,
                                 "JPEG has no alpha; write PNG, WebP or TIFF, or an opaque background");
    writer w = {0};
    guard_init(&w.guard);
    w.jpeg.err = &w.guard.manager;
    static const char xmp_name[] = "http://ns.adobe.com/xap/1.0/"; /* its end is part of it */
    if (samples->options->text_count) text_append_bytes(&w.xmp, xmp_name, sizeof xmp_name);
    image_xmp(samples->options, &w.xmp);
    bool encoded = write_guarded(&w, samples);
    jpeg_destroy_compress(&w.jpeg);
    bool done = encoded ? file_replace(samples->path, w.bytes, w.size, samples->report)
                        : image_not_written(samples->path, samples->report, "%s", w.guard.message);
    free(w.bytes);
    text_free(&w.xmp);
    return done;
}
