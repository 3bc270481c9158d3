/* job/convert.c: a scene-linear picture as a display shows it. */
#include <string.h>

#include "job/compare.h"
#include "job/outputs.h"
#include "job/picture.h"
#include "kiln/color.h"

static bool check_outputs(const job_options *o, const char *source, kiln_report *report) {
    if (!o->outputs.count)
        return report_error(report, KILN_CODE_USAGE, NULL, "kiln color picture.exr -o picture.png",
                            "nothing says what to write");
    for (uint32_t i = 0; i < o->outputs.count; i++) {
        kiln_where where = where_root(o->outputs.items[i]);
        if (output_kind_of(o->outputs.items[i]) != OUTPUT_DISPLAY)
            return report_error(report, KILN_CODE_USAGE, &where, "use .png, .jpg, .webp or .tif",
                                "a view makes pictures for displays");
        if (file_same(file_identify(o->outputs.items[i]), file_identify(source)))
            return report_error(report, KILN_CODE_USAGE, &where, "give another name", "is the picture that is read");
    }
    return true;
}

static bool write_view(const job_options *o, const kiln_color *color, picture_pixels *p, kiln_report *report) {
    kiln_view *view;
    kiln_view_options options = {o->display, o->view, o->look, o->exposure};
    if (!kiln_view_create(color, &options, &view, report)) return false;
    kiln_image image = {p->width, p->height, 3, KILN_PIXELS_F32, p->rgb}; /* borrows the pixels */
    kiln_image_write_options written = {.srgb = kiln_view_is_srgb(view)};
    kiln_view_cicp(view, &written.cicp_primaries, &written.cicp_transfer);
    kiln_view_apply(view, p->rgb, (size_t)p->width * p->height, 3);
    kiln_view_destroy(view);
    bool all = true;
    for (uint32_t i = 0; i < o->outputs.count; i++)
        all = image_write_display(o->outputs.items[i], &image, &written, report) && all;
    return all;
}

bool convert_file(const job_options *o, const char *file, kiln_report *report) {
    picture_pixels pixels;
    kiln_color *color;
    kiln_where where = where_root(file);
    if (!check_outputs(o, file, report) || !picture_read(file, &pixels, report)) return false;
    bool done = pixels.linear ||
                report_error(report, KILN_CODE_IMAGE, &where, "give an .exr or .hdr file",
                             "is display-referred: there is nothing to convert");
    if (done && kiln_color_create(&(kiln_color_options){o->ocio, o->working_space}, &color, report)) {
        done = write_view(o, color, &pixels, report);
        kiln_color_destroy(color);
    } else done = false;
    picture_pixels_free(&pixels);
    return done;
}
