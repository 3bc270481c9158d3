#include "scene/check.h"

static bool check_pixels(const kiln_image_desc *d, const kiln_where *where, kiln_report *report) {
    enum { SIDE_MAX = 65536 };
    if (d->width < 1 || d->height < 1 || d->width > SIDE_MAX || d->height > SIDE_MAX)
        return report_error(report, KILN_CODE_RANGE, where, NULL, "%u × %u pixels (each side from 1 to %d)", d->width,
                            d->height, SIDE_MAX);
    if (d->channels < 1 || d->channels > 4)
        return report_error(report, KILN_CODE_RANGE, where, NULL, "%u channels (1 to 4)", d->channels);
    return check_choice(d->format, KILN_PIXELS_F32 + 1, "pixel format", where, report);
}

static bool check_image(const kiln_image_desc *d, const kiln_where *where, kiln_report *report) {
    if (!d->encoded == !d->pixels)
        return report_error(report, KILN_CODE_USAGE, where, NULL, "an image is either an encoded file or pixels");
    if (d->pixels) return check_pixels(d, where, report);
    return d->encoded_size || report_error(report, KILN_CODE_IMAGE, where, NULL, "the image file is empty");
}

/* Copies the bytes unless the caller lends them. */
static bool keep_bytes(kiln_scene *scene, kiln_image_desc *image, kiln_report *report) {
    static const size_t value_bytes[] = {[KILN_PIXELS_U8] = 1, [KILN_PIXELS_U16] = 2, [KILN_PIXELS_F32] = 4};
    if (!image->release) {
        if (image->encoded) image->encoded = arena_copy(&scene->arena, image->encoded, image->encoded_size, 1);
        else
            image->pixels = arena_copy(&scene->arena, image->pixels, (size_t)image->width * image->height,
                                       image->channels * value_bytes[image->format]);
    }
    image->name = arena_string(&scene->arena, image->name);
    image->place = arena_string(&scene->arena, image->place);
    return (image->name && image->place && (image->encoded || image->pixels)) || report_no_memory(report, "keeping an image");
}

bool kiln_scene_add_image(kiln_scene *scene, const kiln_image_desc *desc, kiln_id *id, kiln_report *report) {
    scene_place place;
    place_set(&place, scene, "image", desc->name, (size_t)scene->image_count + 1);
    kiln_image_desc image = *desc;
    if (!check_open(scene, &place.where, report) || !check_image(&image, &place.where, report) ||
        !keep_bytes(scene, &image, report) ||
        !array_room((void **)&scene->images, scene->image_count, sizeof image, report)) {
        if (desc->release) desc->release(desc->release_user);
        return false;
    }
    scene->images[scene->image_count++] = image;
    if (id) *id = scene->image_count;
    return true;
}
