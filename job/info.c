#include "job/info.h"

#include <string.h>

#include "job/stats.h"

typedef const char *(*namer)(const kiln_color *, size_t);

static json_t *list_names(const kiln_color *color, namer name) {
    json_t *array = json_array();
    for (size_t i = 0; name(color, i); i++) (void)json_array_append_new(array, json_text_of(name(color, i)));
    return array;
}

static json_t *list_views(const kiln_color *color, const char *display) {
    json_t *array = json_array();
    for (size_t i = 0; kiln_color_view(color, display, i); i++)
        (void)json_array_append_new(array, json_text_of(kiln_color_view(color, display, i)));
    return array;
}

static bool put_color(const job_options *o, json_t *to, kiln_report *report) {
    kiln_color *color;
    kiln_view *view;
    if (!kiln_color_create(&(kiln_color_options){o->ocio, o->working_space}, &color, report)) return false;
    bool done = kiln_view_create(color, &(kiln_view_options){o->display, o->view, o->look, o->exposure}, &view, report);
    if (done) {
        json_t *displays = json_array();
        put_text(to, "config", kiln_color_describe(color));
        put_text(to, "default", kiln_view_describe(view));
        for (size_t i = 0; kiln_color_display(color, i); i++) {
            json_t *row = json_object();
            put_text(row, "name", kiln_color_display(color, i));
            put(row, "views", list_views(color, kiln_color_display(color, i)));
            (void)json_array_append_new(displays, row);
        }
        put(to, "displays", displays);
        put(to, "looks", list_names(color, kiln_color_look));
        put(to, "spaces", list_names(color, kiln_color_space));
        kiln_view_destroy(view);
    }
    kiln_color_destroy(color);
    return done;
}

static json_t *list_texts(const char *const *texts) {
    json_t *array = json_array();
    for (; *texts; texts++) (void)json_array_append_new(array, json_string(*texts));
    return array;
}

static json_t *formats(void) {
    static const char *const scenes[] = {".gltf", ".glb", NULL},
                             *const textures[] = {"PNG", "JPEG", "WebP", "TIFF", "OpenEXR", "Radiance HDR", NULL},
                             *const outputs[] = {".png", ".jpg", ".webp", ".tif", ".exr", ".hdr", NULL};
    json_t *o = json_object();
    put(o, "scenes", list_texts(scenes));
    put(o, "pictures_read", list_texts(textures));
    put(o, "pictures_written", list_texts(outputs));
    return o;
}

json_t *info_make(const job_options *o, kiln_report *report) {
    json_t *color = json_object(), *info = json_object();
    if (!put_color(o, color, report)) {
        json_decref(color);
        json_decref(info);
        return NULL;
    }
    put(info, "versions", stats_versions());
    put(info, "machine", stats_machine(o->threads));
    put(info, "color", color);
    put(info, "formats", formats());
    return info;
}
