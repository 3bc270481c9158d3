#include "job/compare.h"

#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "image/ramp.h"
#include "job/outputs.h"
#include "job/picture.h"
#include "kiln/compare.h"

typedef struct comparison {
    const job_options *options;
    const char *names[2];
    picture_pixels pictures[2]; /* the picture, the reference */
    json_t *json;
    kiln_report *report;
} comparison;

static bool has_alpha(const picture_pixels *p) { return p->channels % 2 == 0; }

static bool check_shapes(const comparison *c) {
    const picture_pixels *a = &c->pictures[0], *b = &c->pictures[1];
    kiln_where where = where_root(c->names[0]);
    if (a->width != b->width || a->height != b->height)
        return report_error(c->report, KILN_CODE_IMAGE, &where, NULL, "has %u x %u pixels, and %s %u x %u", a->width,
                            a->height, c->names[1], b->width, b->height);
    if (has_alpha(a) != has_alpha(b))
        return report_error(c->report, KILN_CODE_IMAGE, &where, NULL, "has %u channels, and %s %u: only one has alpha",
                            a->channels, c->names[1], b->channels);
    return a->linear == b->linear ||
           report_error(c->report, KILN_CODE_IMAGE, &where, "convert one with 'kiln color'",
                        "is %s, and %s is %s", a->linear ? "scene-linear" : "display-referred", c->names[1],
                        b->linear ? "scene-linear" : "display-referred");
}

static kiln_metric metric_for(kiln_metric metric, bool linear) {
    return metric == KILN_METRIC_FLIP && linear ? KILN_METRIC_HDR_FLIP : metric;
}

static bool measure(const comparison *c, kiln_metric metric, double *error, float *map) {
    const picture_pixels *a = &c->pictures[0];
    kiln_comparison between = {.metric = metric, .width = a->width, .height = a->height, .image = a->rgb,
                                  .reference = c->pictures[1].rgb, .threads = c->options->threads};
    return kiln_compare(&between, error, map, c->report);
}

bool compare_write_map(const char *path, const float *map, uint32_t width, uint32_t height, float end,
                       kiln_report *report) {
    kiln_image image;
    size_t count = (size_t)width * height;
    output_kind kind = output_kind_of(path);
    if (kind == OUTPUT_EXR) {
        const kiln_exr_channel channel = {"Y", map, 1, true};
        const kiln_exr_file file = {.width = width, .height = height, .channels = &channel, .channel_count = 1};
        return image_write_exr(path, &file, report);
    }
    if (!image_alloc(&image, width, height, 3, KILN_PIXELS_F32, report)) return false;
    float *rgb = image.pixels;
    for (size_t i = 0; i < count; i++) {
        if (kind == OUTPUT_HDR) rgb[3 * i] = rgb[3 * i + 1] = rgb[3 * i + 2] = map[i];
        else image_ramp(end > 0 ? map[i] / end : 0, rgb + 3 * i);
    }
    const kiln_image_write_options srgb = {.srgb = true};
    bool done = kind == OUTPUT_HDR ? image_write_hdr(path, &image, NULL, 0, report)
                                   : image_write_display(path, &image, &srgb, report);
    image_free(&image);
    return done;
}

static bool write_maps(const comparison *c, kiln_metric metric, const float *map) {
    const option_list *outputs = &c->options->outputs;
    const picture_pixels *p = &c->pictures[0];
    json_t *files = json_array();
    bool done = true;
    float end = metric == KILN_METRIC_FLIP || metric == KILN_METRIC_HDR_FLIP
                    ? 1
                    : image_ramp_end(map, (size_t)p->width * p->height);
    if (end < 0) done = report_no_memory(c->report, "drawing a map");
    for (uint32_t i = 0; done && i < outputs->count; i++) {
        done = compare_write_map(outputs->items[i], map, p->width, p->height, end, c->report);
        (void)json_array_append_new(files, json_text_of(outputs->items[i]));
    }
    put(c->json, "maps", files);
    put_text(c->json, "map_metric", kiln_metric_name(metric));
    put_number(c->json, "map_end", (double)end);
    return done;
}

static bool judge(const comparison *c, kiln_metric metric, double error) {
    const job_options *o = c->options;
    kiln_where where = where_root(c->names[0]);
    if (!job_given(o, threshold)) return true;
    put_number(c->json, "threshold", o->threshold);
    put_bool(c->json, "above", error > o->threshold);
    return error <= o->threshold ||
           report_error(c->report, KILN_CODE_DIFFERENT, &where, NULL,
                        "%s against %s is %.6g, above the threshold of %.6g", kiln_metric_name(metric), c->names[1],
                        error, o->threshold);
}

/* All metrics, unless one is named; the first is what is mapped and judged. */
static bool measure_all(const comparison *c) {
    static const kiln_metric every[] = {KILN_METRIC_RELMSE, KILN_METRIC_MSE, KILN_METRIC_MAE, KILN_METRIC_FLIP};
    const job_options *o = c->options;
    const picture_pixels *p = &c->pictures[0];
    bool one = job_given(o, metric) || job_given(o, threshold);
    uint32_t count = one ? 1 : sizeof every / sizeof *every;
    json_t *errors = json_object();
    float *map = o->outputs.count ? array_alloc((size_t)p->width * p->height, sizeof *map) : NULL;
    bool done = !o->outputs.count || map || report_no_memory(c->report, "comparing pictures");
    double first = 0;
    for (uint32_t i = 0; done && i < count; i++) {
        kiln_metric metric = metric_for(one ? o->metric : every[i], p->linear);
        double error;
        done = measure(c, metric, &error, i ? NULL : map);
        if (done) put_number(errors, kiln_metric_name(metric), error);
        if (!i) first = error;
    }
    put(c->json, "metrics", errors);
    kiln_metric judged = metric_for(o->metric, p->linear);
    done = done && (!map || write_maps(c, judged, map)) && judge(c, judged, first);
    free(map);
    return done;
}

/* Maps do not replace what is compared, and have names that tell their format. */
static bool check_outputs(const comparison *c) {
    const option_list *outputs = &c->options->outputs;
    for (uint32_t i = 0; i < outputs->count; i++) {
        kiln_where where = where_root(outputs->items[i]);
        if (output_kind_of(outputs->items[i]) == OUTPUT_UNKNOWN)
            return report_error(c->report, KILN_CODE_USAGE, &where, "use .exr, .hdr, .png, .jpg, .webp or .tif",
                                "the suffix names no format that kiln writes");
        for (int k = 0; k < 2; k++)
            if (file_same(file_identify(outputs->items[i]), file_identify(c->names[k])))
                return report_error(c->report, KILN_CODE_USAGE, &where, "give another name",
                                    "is one of the pictures that are compared");
    }
    return true;
}

bool compare_files(const job_options *o, const char *file, const char *reference, json_t **json, kiln_report *report) {
    comparison c = {.options = o, .names = {file, reference}, .json = json_object(), .report = report};
    *json = c.json;
    put_text(c.json, "picture", file);
    put_text(c.json, "reference", reference);
    bool done = check_outputs(&c) && picture_read(file, &c.pictures[0], report) &&
                picture_read(reference, &c.pictures[1], report) && check_shapes(&c);
    if (done) {
        put_count(c.json, "width", c.pictures[0].width);
        put_count(c.json, "height", c.pictures[0].height);
        done = measure_all(&c);
    }
    for (int k = 0; k < 2; k++) picture_pixels_free(&c.pictures[k]);
    return done;
}
