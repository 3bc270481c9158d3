#include <webp/decode.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include <stdlib.h>

#include "base/file.h"
#include "image/codec.h"
#include "image/icc.h"

static bool read_failed(const image_source *source, VP8StatusCode status) {
    switch (status) {
    case VP8_STATUS_OUT_OF_MEMORY: return report_no_memory(source->report, "reading a WebP image");
    case VP8_STATUS_SUSPENDED:
    case VP8_STATUS_NOT_ENOUGH_DATA: return image_truncated(source, "WebP");
    case VP8_STATUS_OK:
    case VP8_STATUS_INVALID_PARAM:
    case VP8_STATUS_BITSTREAM_ERROR:
    case VP8_STATUS_UNSUPPORTED_FEATURE:
    case VP8_STATUS_USER_ABORT: break;
    }
    return image_damaged(source, "WebP", "the bitstream is invalid");
}

bool image_read_webp(const image_source *source, kiln_image_info *info, kiln_image *image) {
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config)) return report_no_memory(source->report, "reading a WebP image");
    VP8StatusCode status = WebPGetFeatures(source->bytes, source->size, &config.input);
    if (status != VP8_STATUS_OK) return read_failed(source, status);
    if (config.input.has_animation)
        return image_refuse(source, KILN_CODE_IMAGE, "export one frame of it", "animated WebP images cannot be read");
    info->width = (uint32_t)config.input.width;
    info->height = (uint32_t)config.input.height;
    info->channels = config.input.has_alpha ? 4 : 3;
    info->format = KILN_PIXELS_U8;
    if (!image) return true;
    if (!image_prepare(source, info, image)) return false;
    config.output.colorspace = config.input.has_alpha ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA = (WebPRGBABuffer){image->pixels, (int)(info->width * info->channels), image_bytes(image)};
    status = WebPDecode(source->bytes, source->size, &config);
    return status == VP8_STATUS_OK || read_failed(source, status);
}

static unsigned char *grey_to_rgb(const image_samples *s) {
    size_t count = (size_t)s->width * s->height, to = s->channels == 1 ? 3 : 4;
    unsigned char *rgb = malloc(count * to);
    for (size_t i = 0; rgb && i < count; i++) {
        const unsigned char *from = s->bytes + i * s->channels;
        for (size_t c = 0; c < 3; c++) rgb[i * to + c] = from[0];
        if (to == 4) rgb[i * to + 3] = from[1];
    }
    return rgb;
}

static bool encode(const image_samples *s, const unsigned char *rgb, WebPMemoryWriter *memory) {
    WebPConfig config;
    WebPPicture picture;
    float quality = s->options->quality ? (float)s->options->quality : 95.0f;
    bool alpha = s->channels == 2 || s->channels == 4;
    if (!WebPConfigPreset(&config, WEBP_PRESET_DEFAULT, quality) || !WebPPictureInit(&picture))
        return image_not_written(s->path, s->report, "libwebp is of another version");
    config.lossless = quality >= 100.0f;
    config.exact = 1; /* keeps the colour under alpha 0 */
    picture.use_argb = config.lossless;
    picture.width = (int)s->width;
    picture.height = (int)s->height;
    picture.writer = WebPMemoryWrite;
    picture.custom_ptr = memory;
    int stride = (int)(s->width * (alpha ? 4 : 3));
    bool done = alpha ? WebPPictureImportRGBA(&picture, rgb, stride) : WebPPictureImportRGB(&picture, rgb, stride);
    done = done && WebPEncode(&config, &picture);
    int code = picture.error_code;
    WebPPictureFree(&picture);
    if (!done && code == VP8_ENC_ERROR_OUT_OF_MEMORY) return report_no_memory(s->report, "writing a WebP image");
    return done || image_not_written(s->path, s->report, "libwebp error %d", code);
}

static bool add_chunk(WebPMux *mux, const char *name, const void *bytes, size_t size) {
    const WebPData chunk = {bytes, size};
    return !size || WebPMuxSetChunk(mux, name, &chunk, 0) == WEBP_MUX_OK;
}

/* Puts the encoded picture into a container with its profile and its text. *file: WebPDataClear. */
static bool wrap(const image_samples *s, const WebPMemoryWriter *picture, WebPData *file) {
    const WebPData bare = {picture->mem, picture->size};
    unsigned char profile[IMAGE_ICC_MAX];
    kiln_text xmp = {0};
    WebPMux *mux = WebPMuxNew();
    image_xmp(s->options, &xmp);
    bool done = mux && WebPMuxSetImage(mux, &bare, 0) == WEBP_MUX_OK &&
                add_chunk(mux, "ICCP", profile, image_icc(s->options, profile)) &&
                add_chunk(mux, "XMP ", xmp.data, xmp.length) && WebPMuxAssemble(mux, file) == WEBP_MUX_OK;
    WebPMuxDelete(mux);
    text_free(&xmp);
    return done || report_no_memory(s->report, "writing a WebP image"); /* nothing else can fail */
}

bool image_write_webp(const image_samples *s) {
    if (s->width > WEBP_MAX_DIMENSION || s->height > WEBP_MAX_DIMENSION)
        return image_not_written(s->path, s->report, "WebP holds at most %d pixels a side", WEBP_MAX_DIMENSION);
    unsigned char *expanded = s->channels < 3 ? grey_to_rgb(s) : NULL;
    if (s->channels < 3 && !expanded) return report_no_memory(s->report, "writing a WebP image");
    WebPMemoryWriter memory;
    WebPData file = {NULL, 0};
    WebPMemoryWriterInit(&memory);
    bool done = encode(s, expanded ? expanded : s->bytes, &memory) && wrap(s, &memory, &file) &&
                file_replace(s->path, file.bytes, file.size, s->report);
    WebPDataClear(&file);
    WebPMemoryWriterClear(&memory);
    free(expanded);
    return done;
}
