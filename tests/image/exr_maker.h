/* OpenEXR files of every form, made with the library's own encoder. Include after support.h. */
#ifndef KILN_TESTS_EXR_MAKER_H
#define KILN_TESTS_EXR_MAKER_H

#include <openexr.h>

typedef struct exr_form {
    const char *channels[8]; /* sorted by name */
    exr_pixel_type_t type;
    exr_compression_t compression;
    int tile; /* side; 0: scanlines */
    int data[4], display[4]; /* x0 y0 x1 y1, inclusive */
    int sampling;            /* of every channel but Y; 0: 1 */
} exr_form;

static inline int64_t exr_maker_write(exr_const_context_t context, void *user, const void *data, uint64_t count,
                                      uint64_t offset, exr_stream_error_func_ptr_t error) {
    (void)context, (void)error;
    kiln_text *out = user;
    while (out->length < offset + count) text_append_bytes(out, "", 1);
    memcpy(out->data + offset, data, count);
    return (int64_t)count;
}

static inline void exr_maker_ok(exr_result_t code) {
    if (code) fail_msg("OpenEXR: %s", exr_get_default_error_message(code));
}

/* value(x, y, channel) in the file's frame, as floats. */
typedef float exr_value(int x, int y, int channel);

static inline void exr_maker_chunk(exr_context_t file, int part, const exr_chunk_info_t *chunk, const exr_form *f,
                                   int x0, int y0, exr_value *value) {
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    float *planes[8] = {0};
    exr_maker_ok(exr_encoding_initialize(file, part, chunk, &encode));
    for (int c = 0; c < encode.channel_count; c++) {
        exr_coding_channel_info_t *info = &encode.channels[c];
        size_t count = (size_t)chunk->width * (size_t)chunk->height;
        planes[c] = malloc(count * sizeof(float) + 4);
        for (int y = 0; y < info->height; y++)
            for (int x = 0; x < info->width; x++) {
                float v = value(x0 + x * info->x_samples, y0 + y * info->y_samples, c);
                uint32_t whole = (uint32_t)v;
                memcpy(&planes[c][y * info->width + x], f->type == EXR_PIXEL_UINT ? (void *)&whole : (void *)&v, 4);
            }
        info->encode_from_ptr = (const uint8_t *)planes[c];
        info->user_bytes_per_element = 4;
        info->user_data_type = f->type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        info->user_pixel_stride = 4;
        info->user_line_stride = 4 * info->width;
    }
    exr_maker_ok(exr_encoding_choose_default_routines(file, part, &encode));
    exr_maker_ok(exr_encoding_run(file, part, &encode));
    exr_encoding_destroy(file, &encode);
    for (int c = 0; c < 8; c++) free(planes[c]);
}

static inline void exr_maker_part(exr_context_t file, int part, const exr_form *f, exr_value *value) {
    const int *d = f->data;
    exr_chunk_info_t chunk;
    if (f->tile) {
        for (int y = d[1], row = 0; y <= d[3]; y += f->tile, row++)
            for (int x = d[0], column = 0; x <= d[2]; x += f->tile, column++) {
                exr_maker_ok(exr_write_tile_chunk_info(file, part, column, row, 0, 0, &chunk));
                exr_maker_chunk(file, part, &chunk, f, x, y, value);
            }
        return;
    }
    int32_t lines;
    exr_maker_ok(exr_get_scanlines_per_chunk(file, part, &lines));
    for (int y = d[1]; y <= d[3]; y += lines) {
        exr_maker_ok(exr_write_scanline_chunk_info(file, part, y, &chunk));
        exr_maker_chunk(file, part, &chunk, f, d[0], y, value);
    }
}

static inline kiln_text make_exr(const exr_form *parts, int count, exr_value *value) {
    kiln_text out = {0};
    exr_context_t file;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.user_data = &out;
    setup.write_fn = exr_maker_write;
    exr_maker_ok(exr_start_write(&file, "made", EXR_WRITE_FILE_DIRECTLY, &setup));
    for (int p = 0; p < count; p++) {
        const exr_form *f = &parts[p];
        char name[16];
        int index;
        snprintf(name, sizeof name, "part%d", p);
        exr_maker_ok(exr_add_part(file, name, f->tile ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &index));
        exr_attr_box2i_t data = {.min = {.x = f->data[0], .y = f->data[1]}, .max = {.x = f->data[2], .y = f->data[3]}};
        exr_attr_box2i_t display = {.min = {.x = f->display[0], .y = f->display[1]},
                                    .max = {.x = f->display[2], .y = f->display[3]}};
        exr_maker_ok(exr_initialize_required_attr(file, p, &display, &data, 1, &(exr_attr_v2f_t){.x = 0, .y = 0}, 1,
                                                  EXR_LINEORDER_INCREASING_Y, f->compression));
        if (f->tile)
            exr_maker_ok(exr_set_tile_descriptor(file, p, (uint32_t)f->tile, (uint32_t)f->tile, EXR_TILE_ONE_LEVEL,
                                                 EXR_TILE_ROUND_DOWN));
        for (int c = 0; f->channels[c]; c++) {
            int step = f->sampling && strcmp(f->channels[c], "Y") ? f->sampling : 1;
            exr_maker_ok(exr_add_channel(file, p, f->channels[c], f->type, EXR_PERCEPTUALLY_LOGARITHMIC, step, step));
        }
    }
    exr_maker_ok(exr_write_header(file));
    for (int p = 0; p < count; p++) exr_maker_part(file, p, &parts[p], value);
    exr_maker_ok(exr_finish(&file));
    return out;
}

#endif
