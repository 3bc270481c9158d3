#include <openexr.h>

#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "image/codec.h"
#include "image/half.h"

/* The library (OpenEXRCore) parses the header and decompresses chunks; unpacking a chunk into pixels is done here,
 * with its size checked, for that is where hostile files have hurt the library's own routines. */

enum { SIDE_MAX = 65536, CHANNELS_MAX = 1024 };

typedef struct reader {
    const image_source *source;
    char message[256]; /* the library's first error */
    exr_context_t context;
    int part;
    exr_attr_box2i_t data, display;
    const exr_attr_chlist_t *channels;
    int pick[4]; /* which of the file's channels become the image's */
    uint32_t pick_count;
    kiln_image *image;
} reader;

static int64_t read_bytes(exr_const_context_t context, void *user, void *to, uint64_t count, uint64_t offset,
                          exr_stream_error_func_ptr_t error) {
    const image_source *source = ((reader *)user)->source;
    (void)context, (void)error;
    uint64_t left = offset < source->size ? source->size - offset : 0, take = count < left ? count : left;
    if (take) memcpy(to, source->bytes + offset, take);
    return (int64_t)take;
}

static int64_t source_size(exr_const_context_t context, void *user) {
    (void)context;
    return (int64_t)((reader *)user)->source->size;
}

static void on_error(exr_const_context_t context, exr_result_t code, const char *message) {
    void *user = NULL;
    (void)code;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user) return;
    reader *r = user;
    if (!r->message[0]) snprintf(r->message, sizeof r->message, "%s", message);
}

static bool damaged(reader *r, exr_result_t code) {
    if (code == EXR_ERR_OUT_OF_MEMORY) return report_no_memory(r->source->report, "reading an OpenEXR image");
    if (code == EXR_ERR_FEATURE_NOT_IMPLEMENTED) /* DWAA and DWAB, in OpenEXRCore 3.1 */
        return image_refuse(r->source, KILN_CODE_IMAGE, "save it with ZIP or PIZ compression",
                            "the OpenEXR library has no decoder for this file's compression");
    return image_damaged(r->source, "OpenEXR", r->message[0] ? r->message : exr_get_default_error_message(code));
}

static int find_channel(const exr_attr_chlist_t *channels, const char *name) {
    for (int i = 0; i < channels->num_channels; i++)
        if (strcmp(channels->entries[i].name.str, name) == 0) return i;
    return -1;
}

/* RGB, else luminance, else a lone R; with A where there is one. False when the part has none of them. */
static bool pick_channels(reader *r, const exr_attr_chlist_t *channels) {
    int red = find_channel(channels, "R"), green = find_channel(channels, "G"), blue = find_channel(channels, "B");
    int luminance = find_channel(channels, "Y"), alpha = find_channel(channels, "A");
    r->pick_count = 0;
    if (red >= 0 && green >= 0 && blue >= 0) {
        r->pick[r->pick_count++] = red;
        r->pick[r->pick_count++] = green;
        r->pick[r->pick_count++] = blue;
    } else if (luminance >= 0 || (red >= 0 && green < 0 && blue < 0))
        r->pick[r->pick_count++] = luminance >= 0 ? luminance : red;
    else return false;
    if (alpha >= 0) r->pick[r->pick_count++] = alpha;
    return true;
}

/* Names what the first part has instead: "Z, beauty.B, beauty.G, …". */
static bool no_picture(reader *r) {
    const exr_attr_chlist_t *channels = NULL;
    kiln_text names = {0};
    (void)exr_get_channels(r->context, 0, &channels);
    for (int i = 0; channels && i < channels->num_channels && i < 8; i++)
        text_format(&names, "%s%s", i ? ", " : "", channels->entries[i].name.str);
    if (channels && channels->num_channels > 8) text_append(&names, ", …");
    image_refuse(r->source, KILN_CODE_IMAGE, "rename or copy the channels to R, G, B and A, or Y",
                 "no flat part of the OpenEXR file has channels R, G and B, or Y (it has %s)",
                 names.data ? names.data : "none");
    text_free(&names);
    return false;
}

static bool find_part(reader *r) {
    int parts = 0;
    exr_result_t code = exr_get_count(r->context, &parts);
    for (r->part = 0; !code && r->part < parts; r->part++) {
        exr_storage_t storage;
        code = exr_get_storage(r->context, r->part, &storage);
        if (!code) code = exr_get_channels(r->context, r->part, &r->channels);
        if (code) break;
        if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED) continue;
        if (pick_channels(r, r->channels)) return true;
    }
    return code ? damaged(r, code) : no_picture(r);
}

static bool check_channels(reader *r) {
    for (int i = 0; i < r->channels->num_channels; i++) {
        const exr_attr_chlist_entry_t *c = &r->channels->entries[i];
        if (c->x_sampling != 1 || c->y_sampling != 1)
            return image_refuse(r->source, KILN_CODE_IMAGE, "save the image without subsampling",
                                "channel %s of the OpenEXR file is subsampled", c->name.str);
    }
    if (r->pick_count <= 2 && find_channel(r->channels, "RY") >= 0)
        return image_refuse(r->source, KILN_CODE_IMAGE, "save the image as RGB",
                            "OpenEXR images of luminance and chroma cannot be read");
    if (r->channels->num_channels > CHANNELS_MAX)
        return image_refuse(r->source, KILN_CODE_LIMIT, "keep only the channels in use",
                            "the OpenEXR file has more than %d channels", CHANNELS_MAX);
    return true;
}

static bool side(int32_t low, int32_t high, uint32_t *size) {
    int64_t count = (int64_t)high - low + 1;
    *size = count < 0 ? 0 : count > UINT32_MAX ? UINT32_MAX : (uint32_t)count;
    return *size <= SIDE_MAX;
}

/* The picture is the display window: what the data window holds of it, and zero elsewhere. */
static bool read_header(reader *r, kiln_image_info *info) {
    exr_result_t code;
    uint32_t width, height;
    if (!find_part(r) || !check_channels(r)) return false;
    if ((code = exr_get_data_window(r->context, r->part, &r->data)) ||
        (code = exr_get_display_window(r->context, r->part, &r->display)))
        return damaged(r, code);
    if (!side(r->data.min.x, r->data.max.x, &width) || !side(r->data.min.y, r->data.max.y, &height))
        return image_refuse(r->source, KILN_CODE_LIMIT, "scale the image down",
                            "the OpenEXR data window is larger than %d pixels a side", SIDE_MAX);
    (void)side(r->display.min.x, r->display.max.x, &info->width);
    (void)side(r->display.min.y, r->display.max.y, &info->height);
    info->channels = r->pick_count;
    info->format = KILN_PIXELS_F32;
    return true;
}

static float load(const unsigned char *from, uint16_t type) {
    uint32_t whole;
    uint16_t half;
    float value;
    memcpy(&half, from, sizeof half);
    if (type == EXR_PIXEL_HALF) return half_to_float(half);
    memcpy(&whole, from, sizeof whole);
    memcpy(&value, from, sizeof value);
    return type == EXR_PIXEL_UINT ? (float)whole : value;
}

/* One line of one channel, clipped to the picture. x and y are in the file's frame. */
static void put_line(reader *r, const unsigned char *from, uint16_t type, int64_t x, int64_t y, int32_t count,
                     uint32_t channel) {
    size_t size = type == EXR_PIXEL_HALF ? 2 : 4;
    int64_t row = y - r->display.min.y, column = x - r->display.min.x;
    if (row < 0 || row >= r->image->height) return;
    for (int32_t i = 0; i < count; i++, column++) {
        if (column < 0 || column >= r->image->width) continue;
        size_t pixel = (size_t)row * r->image->width + (size_t)column;
        ((float *)r->image->pixels)[pixel * r->image->channels + channel] = load(from + (size_t)i * size, type);
    }
}

/* A chunk holds its lines one after the other, a line its channels in the file's order (little-endian, as is every
 * machine that the library supports directly). */
static exr_result_t unpack(exr_decode_pipeline_t *decode) {
    reader *r = decode->decoding_user_data;
    const exr_chunk_info_t *chunk = &decode->chunk;
    const unsigned char *at = decode->unpacked_buffer;
    uint64_t line_bytes = 0;
    for (int c = 0; c < decode->channel_count; c++)
        line_bytes += (uint64_t)chunk->width * (decode->channels[c].data_type == EXR_PIXEL_HALF ? 2 : 4);
    if (!at || chunk->width <= 0 || chunk->height <= 0 || chunk->packed_size == 0 ||
        line_bytes * (uint64_t)chunk->height > chunk->unpacked_size)
        return EXR_ERR_CORRUPT_CHUNK;
    int64_t x = r->data.min.x, y = chunk->start_y;
    if (chunk->type == EXR_STORAGE_TILED) {
        int32_t tile_width = 0, tile_height = 0;
        exr_result_t code = exr_get_tile_sizes(r->context, r->part, 0, 0, &tile_width, &tile_height);
        if (code) return code;
        x += (int64_t)chunk->start_x * tile_width;
        y = r->data.min.y + (int64_t)chunk->start_y * tile_height;
    }
    for (int32_t line = 0; line < chunk->height; line++)
        for (int c = 0; c < decode->channel_count; c++) {
            uint16_t type = decode->channels[c].data_type;
            for (uint32_t k = 0; k < r->pick_count; k++)
                if (r->pick[k] == c) put_line(r, at, type, x, y + line, chunk->width, k);
            at += (size_t)chunk->width * (type == EXR_PIXEL_HALF ? 2 : 4);
        }
    return EXR_ERR_SUCCESS;
}

static exr_result_t read_chunk(reader *r, const exr_chunk_info_t *chunk, exr_decode_pipeline_t *decode) {
    exr_result_t code;
    if (chunk->packed_size > r->source->size) return EXR_ERR_CORRUPT_CHUNK;
    if (decode->channels) code = exr_decoding_update(r->context, r->part, chunk, decode);
    else {
        code = exr_decoding_initialize(r->context, r->part, chunk, decode);
        if (!code) code = exr_decoding_choose_default_routines(r->context, r->part, decode);
        decode->unpack_and_convert_fn = unpack;
        decode->decoding_user_data = r;
    }
    return code ? code : exr_decoding_run(r->context, r->part, decode);
}

static exr_result_t read_scanlines(reader *r, exr_decode_pipeline_t *decode) {
    int32_t lines = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(r->context, r->part, &lines);
    for (int64_t y = r->data.min.y; !code && y <= r->data.max.y; y += lines) {
        exr_chunk_info_t chunk;
        if (lines <= 0) return EXR_ERR_CORRUPT_CHUNK;
        if (y + lines <= r->display.min.y || y > r->display.max.y) continue;
        code = exr_read_scanline_chunk_info(r->context, r->part, (int)y, &chunk);
        if (!code) code = read_chunk(r, &chunk, decode);
    }
    return code;
}

static exr_result_t read_tiles(reader *r, exr_decode_pipeline_t *decode) {
    int32_t tile_width = 0, tile_height = 0;
    exr_result_t code = exr_get_tile_sizes(r->context, r->part, 0, 0, &tile_width, &tile_height);
    if (!code && (tile_width <= 0 || tile_height <= 0)) return EXR_ERR_CORRUPT_CHUNK;
    int64_t y = r->data.min.y;
    for (int row = 0; !code && y <= r->data.max.y; row++, y += tile_height) {
        int64_t x = r->data.min.x;
        for (int column = 0; !code && x <= r->data.max.x; column++, x += tile_width) {
            exr_chunk_info_t chunk;
            code = exr_read_tile_chunk_info(r->context, r->part, column, row, 0, 0, &chunk);
            if (!code) code = read_chunk(r, &chunk, decode);
        }
    }
    return code;
}

static bool read_pixels(reader *r) {
    exr_storage_t storage;
    uint64_t chunk_bytes = 0;
    exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t code = exr_get_storage(r->context, r->part, &storage);
    if (!code) code = exr_get_chunk_unpacked_size(r->context, r->part, &chunk_bytes);
    if (!code && chunk_bytes > r->source->limit)
        return image_refuse(r->source, KILN_CODE_LIMIT, "save the image with smaller tiles",
                            "one block of the OpenEXR file needs %llu bytes", (unsigned long long)chunk_bytes);
    if (!code) code = storage == EXR_STORAGE_TILED ? read_tiles(r, &decode) : read_scanlines(r, &decode);
    exr_decoding_destroy(r->context, &decode);
    if (code) return damaged(r, code);
    image_unpremultiply(r->image); /* OpenEXR's colour is premultiplied */
    return true;
}

bool image_read_exr(const image_source *source, kiln_image_info *info, kiln_image *image) {
    reader r = {.source = source, .image = image};
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = on_error;
    setup.user_data = &r;
    setup.read_fn = read_bytes;
    setup.size_fn = source_size;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_result_t code = exr_start_read(&r.context, "image", &setup);
    if (code) return damaged(&r, code);
    bool done = read_header(&r, info);
    if (done && image) done = image_prepare(source, info, image) && read_pixels(&r);
    exr_finish(&r.context);
    return done;
}
