#include <openexr.h>

#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/file.h"
#include "base/threads.h"
#include "image/codec.h"
#include "image/half.h"

typedef struct writer {
    const char *path;
    const kiln_exr_file *file;
    kiln_report *report;
    kiln_writer *to;
    bool disk_failed; /* file_commit will say why */
    exr_context_t context;
    uint32_t x0, y0, width, height; /* the data window */
} writer;

static int64_t write_bytes(exr_const_context_t context, void *user, const void *data, uint64_t count, uint64_t offset,
                           exr_stream_error_func_ptr_t error) {
    (void)context, (void)error;
    writer *w = user;
    w->disk_failed = !file_write_at(w->to, data, count, offset);
    return w->disk_failed ? -1 : (int64_t)count;
}

/* Silence on stderr. The library holds its lock here, so that even its user data is out of reach. */
static void on_error(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

static exr_result_t set_windows(writer *w) {
    const kiln_exr_file *f = w->file;
    exr_attr_box2i_t display = {.min = {.x = 0, .y = 0},
                                .max = {.x = (int32_t)f->width - 1, .y = (int32_t)f->height - 1}};
    exr_attr_box2i_t data = {.min = {.x = (int32_t)w->x0, .y = (int32_t)w->y0},
                             .max = {.x = (int32_t)(w->x0 + w->width) - 1, .y = (int32_t)(w->y0 + w->height) - 1}};
    exr_attr_v2f_t center = {.x = 0, .y = 0};
    return exr_initialize_required_attr(w->context, 0, &display, &data, 1.0f, &center, 1.0f, EXR_LINEORDER_INCREASING_Y,
                                        EXR_COMPRESSION_ZIP);
}

static exr_result_t set_attribute(writer *w, const kiln_exr_attribute *a) {
    switch (a->kind) {
    case KILN_EXR_STRING: return exr_attr_set_string(w->context, 0, a->name, a->string);
    case KILN_EXR_INT: return exr_attr_set_int(w->context, 0, a->name, (int32_t)a->number);
    case KILN_EXR_FLOAT: return exr_attr_set_float(w->context, 0, a->name, (float)a->number);
    case KILN_EXR_DOUBLE: return exr_attr_set_double(w->context, 0, a->name, a->number);
    }
    return EXR_ERR_INVALID_ARGUMENT;
}

static bool has_long_name(const kiln_exr_file *f) {
    bool found = false;
    for (uint32_t i = 0; i < f->channel_count; i++) found = found || strlen(f->channels[i].name) > 31;
    for (uint32_t i = 0; i < f->attribute_count; i++) found = found || strlen(f->attributes[i].name) > 31;
    return found;
}

static exr_result_t write_header(writer *w) {
    const kiln_exr_file *f = w->file;
    int part;
    exr_result_t code = has_long_name(f) ? exr_set_longname_support(w->context, 1) : EXR_ERR_SUCCESS;
    if (!code) code = exr_add_part(w->context, NULL, EXR_STORAGE_SCANLINE, &part);
    if (!code) code = set_windows(w);
    for (uint32_t i = 0; !code && i < f->channel_count; i++)
        code =
            exr_add_channel(w->context, 0, f->channels[i].name, f->channels[i].full ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF,
                            EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    if (!code && f->chromaticities) {
        const float *c = f->chromaticities;
        exr_attr_chromaticities_t xy = {.red_x = c[0], .red_y = c[1], .green_x = c[2], .green_y = c[3],
                                        .blue_x = c[4], .blue_y = c[5], .white_x = c[6], .white_y = c[7]};
        code = exr_attr_set_chromaticities(w->context, 0, "chromaticities", &xy);
    }
    for (uint32_t i = 0; !code && i < f->attribute_count; i++) code = set_attribute(w, &f->attributes[i]);
    return code ? code : exr_write_header(w->context);
}

static const kiln_exr_channel *find_channel(const kiln_exr_file *f, const char *name) {
    for (uint32_t i = 0; i < f->channel_count; i++)
        if (strcmp(f->channels[i].name, name) == 0) return &f->channels[i];
    return NULL;
}

/* Rows one after the other, in a row the channels in the file's order (sorted by name), little-endian. */
static exr_result_t pack(exr_encode_pipeline_t *encode) {
    writer *w = encode->encoding_user_data;
    unsigned char *to = encode->packed_buffer;
    for (int32_t line = 0; line < encode->chunk.height; line++)
        for (int c = 0; c < encode->channel_count; c++) {
            const kiln_exr_channel *channel = find_channel(w->file, encode->channels[c].channel_name);
            size_t row = (size_t)(encode->chunk.start_y + line - (int32_t)w->y0) * w->width;
            const float *from = channel->values + row * channel->stride;
            for (uint32_t x = 0; x < w->width; x++, from += channel->stride) {
                uint16_t half = float_to_half(*from);
                memcpy(to, channel->full ? (const void *)from : &half, channel->full ? 4 : 2);
                to += channel->full ? 4 : 2;
            }
        }
    encode->packed_bytes = (uint64_t)(to - (unsigned char *)encode->packed_buffer);
    return EXR_ERR_SUCCESS;
}

/* Some consecutive blocks of lines, two for each thread, compressed side by side and then written in order. */
enum { BATCH = 64 };

typedef struct batch {
    writer *writer;
    uint32_t first_line, lines; /* of each block */
    exr_encode_pipeline_t blocks[BATCH];
    exr_result_t codes[BATCH];
} batch;

static exr_result_t compress_block(writer *w, int y, exr_encode_pipeline_t *encode) {
    exr_chunk_info_t chunk;
    exr_result_t code = exr_write_scanline_chunk_info(w->context, 0, y, &chunk);
    if (!code) code = exr_encoding_initialize(w->context, 0, &chunk, encode);
    for (int c = 0; !code && c < encode->channel_count; c++) { /* pack knows where the values are; the library asks */
        const kiln_exr_channel *channel = find_channel(w->file, encode->channels[c].channel_name);
        encode->channels[c].encode_from_ptr = (const uint8_t *)channel->values;
        encode->channels[c].user_pixel_stride = encode->channels[c].bytes_per_element;
        encode->channels[c].user_line_stride = encode->channels[c].bytes_per_element * (int32_t)w->width;
    }
    if (!code) code = exr_encoding_choose_default_routines(w->context, 0, encode);
    encode->convert_and_pack_fn = pack;
    encode->encoding_user_data = w;
    encode->yield_until_ready_fn = NULL;
    encode->write_fn = NULL;
    return code ? code : exr_encoding_run(w->context, 0, encode);
}

static void compress(void *context, size_t item, uint32_t thread) {
    batch *b = context;
    (void)thread;
    int y = (int)(b->writer->y0 + b->first_line + (uint32_t)item * b->lines);
    b->codes[item] = compress_block(b->writer, y, &b->blocks[item]);
}

/* Readers take a block for raw when it is as long as it would be raw. The library writes such a block, and any that would
 * be longer, raw; but one that is by chance as long when compressed it leaves compressed. */
static exr_result_t write_block(exr_context_t context, const exr_encode_pipeline_t *e) {
    bool shorter = e->compressed_bytes < e->packed_bytes;
    return exr_write_scanline_chunk(context, 0, e->chunk.start_y, shorter ? e->compressed_buffer : e->packed_buffer,
                                    shorter ? e->compressed_bytes : e->packed_bytes);
}

static exr_result_t write_batch(batch *b, size_t count) {
    exr_context_t context = b->writer->context;
    exr_result_t code = EXR_ERR_SUCCESS;
    threads_for(b->writer->file->threads, count, compress, b);
    for (size_t i = 0; i < count; i++) {
        exr_encode_pipeline_t *e = &b->blocks[i];
        if (!code) code = b->codes[i];
        if (!code) code = write_block(context, e);
        exr_encoding_destroy(context, e);
    }
    return code;
}

static exr_result_t write_pixels(writer *w) {
    int32_t lines = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(w->context, 0, &lines);
    uint32_t threads = w->file->threads ? w->file->threads : threads_available();
    uint32_t blocks = threads < BATCH / 2 ? 2 * threads : BATCH;
    batch *b = array_alloc(1, sizeof *b);
    if (!b) code = EXR_ERR_OUT_OF_MEMORY;
    for (uint32_t y = 0; !code && y < w->height; y += (uint32_t)lines * blocks) {
        uint32_t left = (w->height - y + (uint32_t)lines - 1) / (uint32_t)lines;
        b->writer = w;
        b->first_line = y;
        b->lines = (uint32_t)lines;
        code = write_batch(b, left < blocks ? left : blocks);
    }
    free(b);
    return code;
}

static bool check(writer *w) {
    const kiln_exr_file *f = w->file;
    const uint32_t *crop = f->crop;
    kiln_where here = where_root(w->path);
    bool whole = !crop[0] && !crop[1] && !crop[2] && !crop[3];
    w->x0 = crop[0];
    w->y0 = crop[1];
    w->width = whole ? f->width : crop[2] - crop[0];
    w->height = whole ? f->height : crop[3] - crop[1];
    if (!f->width || !f->height || f->width > 1u << 24 || f->height > 1u << 24 || !f->channel_count ||
        (!whole && (crop[0] >= crop[2] || crop[1] >= crop[3] || crop[2] > f->width || crop[3] > f->height)))
        return report_error(w->report, KILN_CODE_INTERNAL, &here, NULL, "the picture has no pixels, or no channels");
    for (uint32_t i = 0; i < f->channel_count; i++)
        if (find_channel(f, f->channels[i].name) != &f->channels[i])
            return report_error(w->report, KILN_CODE_INTERNAL, &here, NULL, "two channels are named %s",
                                f->channels[i].name);
    return true;
}

bool image_write_exr(const char *path, const kiln_exr_file *file, kiln_report *report) {
    writer w = {.path = path, .file = file, .report = report};
    if (!check(&w)) return false;
    w.to = file_create(path, report);
    if (!w.to) return false;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = on_error;
    setup.user_data = &w;
    setup.write_fn = write_bytes;
    setup.zip_level = 4; /* OpenEXR's own default; 9 takes four times as long for a few per cent */
    exr_result_t code = exr_start_write(&w.context, path, EXR_WRITE_FILE_DIRECTLY, &setup);
    if (!code) code = write_header(&w);
    if (!code) code = write_pixels(&w);
    if (w.context) {
        exr_result_t finished = exr_finish(&w.context); /* writes the table of chunks */
        if (!code) code = finished;
    }
    if (!code || w.disk_failed) return file_commit(w.to, report);
    file_discard(w.to);
    return image_not_written(path, report, "%s", exr_get_default_error_message(code));
}
