#include "job/stats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "job/effects.h"
#include "job/machine.h"
#include "job/metadata.h"
#include "scene/scene.h"

static void put_version(void *user, const char *name, const char *version) { put_text(user, name, version); }

json_t *stats_versions(void) {
    json_t *o = json_object();
    machine_versions(put_version, o);
    return o;
}

json_t *stats_machine(uint32_t threads) {
    json_t *o = json_object();
    kiln_text model = {0}, features = {0};
    machine_cpu_model(&model);
    machine_cpu_features(&features);
    put_text(o, "cpu", model.data);
    put_text(o, "features", features.data);
    put_text(o, "isa", kiln_render_backend().isa);
    put_count(o, "threads", threads ? threads : threads_available());
    put_count(o, "memory", machine_memory());
    text_free(&model);
    text_free(&features);
    return o;
}

json_t *stats_bounds(kiln_bounds b) {
    bool empty = !(b.min[0] <= b.max[0]);
    if (empty) return json_null();
    json_t *o = json_object();
    double size[3];
    for (int k = 0; k < 3; k++) size[k] = b.max[k] - b.min[k];
    put(o, "min", json_numbers_of(b.min, 3));
    put(o, "max", json_numbers_of(b.max, 3));
    put(o, "size", json_numbers_of(size, 3));
    return o;
}

json_t *stats_camera(const job_view *v) {
    json_t *o = json_object();
    const kiln_camera *c = &v->camera;
    put_text(o, "name", v->name);
    put_bool(o, "automatic", v->automatic);
    put_text(o, "projection", c->projection == KILN_PERSPECTIVE ? "perspective" : "orthographic");
    if (c->projection == KILN_PERSPECTIVE) put_number(o, "fov_deg", c->yfov_rad * 180 / M_PI);
    else put_number(o, "height", 2 * c->ymag);
    put(o, "position", json_numbers_of(c->transform + 12, 3));
    double forward[3] = {-c->transform[8], -c->transform[9], -c->transform[10]};
    put(o, "forward", json_numbers_of(forward, 3));
    put_number(o, "lens_radius", c->lens_radius);
    put(o, "focus_distance", c->focus_distance > 0 ? json_number_of(c->focus_distance) : json_string("auto"));
    put_count(o, "blades", c->blades);
    return o;
}

json_t *stats_messages(const kiln_report *report, kiln_severity severity) {
    json_t *array = json_array();
    for (size_t i = 0; i < kiln_report_size(report); i++) {
        kiln_message m = kiln_report_message(report, i);
        if (m.severity != severity) continue;
        json_t *o = json_object();
        put_text(o, "code", kiln_code_name(m.code));
        put_text(o, "where", m.where);
        put_text(o, "what", m.what);
        put_text(o, "remedy", m.remedy);
        put_count(o, "count", m.count);
        (void)json_array_append_new(array, o);
    }
    return array;
}

json_t *stats_phases(const job_run *r) {
    json_t *array = json_array();
    for (uint32_t i = 0; i < r->phase_count; i++) {
        json_t *o = json_object();
        put_text(o, "name", r->phases[i].name);
        put_number(o, "seconds", r->phases[i].seconds);
        (void)json_array_append_new(array, o);
    }
    return array;
}

static json_t *scene_facts(const job_run *r) {
    json_t *o = json_object();
    kiln_scene_counts c = kiln_scene_count(r->scene);
    put_count(o, "instances", c.instances);
    put_count(o, "meshes", c.meshes);
    put_count(o, "materials", c.materials);
    put_count(o, "images", r->asset_images);
    put_count(o, "lights", c.lights);
    put_count(o, "cameras", c.cameras);
    put_count(o, "triangles", c.triangles);
    put_count(o, "triangles_unique", c.triangles_unique);
    put_count(o, "triangles_before_subdivision", r->cage_triangles);
    put(o, "bounds", stats_bounds(kiln_scene_bounds(r->scene)));
    put_text(o, "light", lighting_describe(&r->lighting, r->options));
    put(o, "camera", stats_camera(&r->view));
    return o;
}

json_t *stats_stages(const kiln_render_stats *s) {
    static const char *const names[KILN_STAGE_COUNT] = {
#define KILN_STAGE_NAME(id, name) name,
        KILN_STAGES(KILN_STAGE_NAME)
#undef KILN_STAGE_NAME
    };
    json_t *array = json_array();
    double total = 0;
    for (int i = 0; i < KILN_STAGE_COUNT; i++) total += s->stage_seconds[i];
    for (int i = 0; i < KILN_STAGE_COUNT; i++) {
        if (s->stage_seconds[i] <= 0) continue;
        json_t *row = json_object();
        put_text(row, "name", names[i]);
        put_number(row, "seconds", s->stage_seconds[i]);
        put_number(row, "share", s->stage_seconds[i] / total);
        (void)json_array_append_new(array, row);
    }
    return array;
}

static json_t *discarded(const kiln_render_stats *s) {
    static const char *const names[KILN_DISCARD_COUNT] = {
#define KILN_DISCARD_NAME(id, name) name,
        KILN_DISCARDS(KILN_DISCARD_NAME)
#undef KILN_DISCARD_NAME
    };
    json_t *o = json_object();
    for (int d = 0; d < KILN_DISCARD_COUNT; d++) {
        json_t *row = json_object();
        put_count(row, "samples", s->discarded[d]);
        if (s->discarded[d]) {
            double pixel[2] = {s->discarded_pixel[d][0], s->discarded_pixel[d][1]};
            put(row, "first_pixel", json_numbers_of(pixel, 2));
        }
        put(o, names[d], row);
    }
    return o;
}

static json_t *error_facts(const job_run *r) {
    const kiln_film_error *e = &r->error;
    if (!e->known) return json_null();
    json_t *o = json_object();
    put_number(o, "relmse", e->relmse);
    put_number(o, "root", sqrt(e->relmse));
    put_number(o, "relmse_low", e->relmse_low);
    put_number(o, "relmse_high", e->relmse_high);
    put_number(o, "relmse_trimmed", e->relmse_trimmed);
    put_bool(o, "heavy_tail", e->heavy_tail);
    return o;
}

static json_t *prediction_facts(const kiln_prediction *p) {
    if (!p->spp) return json_null();
    json_t *o = json_object();
    put_count(o, "samples_per_pixel", p->spp);
    put_number(o, "seconds", p->seconds);
    put_number(o, "error", p->error);
    put_number(o, "noise_seconds", p->noise_seconds >= 0 ? p->noise_seconds : NAN);
    return o;
}

static json_t *render_facts(const job_run *r) {
    static const char *const stops[] = {[KILN_STOP_SPP] = "spp", [KILN_STOP_NOISE] = "noise",
                                        [KILN_STOP_BUDGET] = "budget", [KILN_STOP_CANCELLED] = "interrupted"};
    const kiln_render_stats *s = &r->stats;
    json_t *o = json_object(), *rules = json_object(), *rays = json_object();
    uint64_t samples = kiln_film_samples(r->film);
    put(rules, "spp", r->rules.spp ? json_integer(r->rules.spp) : json_null());
    put(rules, "noise", r->rules.noise > 0 ? json_number_of(r->rules.noise) : json_null());
    put(rules, "budget_seconds", r->rules.budget_seconds > 0 ? json_number_of(r->rules.budget_seconds) : json_null());
    put(o, "rules", rules);
    put_text(o, "ended_by", stops[s->stop]);
    put_bool(o, "noise_missed", run_missed_noise(r));
    put(o, "prediction", prediction_facts(&s->prediction));
    put_number(o, "seconds", s->seconds);
    put_count(o, "samples_per_pixel", s->spp);
    put_bool(o, "adaptive", s->adaptive);
    put_count(o, "samples_per_pixel_least", s->spp_least);
    put_count(o, "samples_per_pixel_most", s->spp_most);
    put_count(o, "samples", samples);
    put_count(o, "pixels_without_samples", s->unsampled);
    put_number(o, "samples_per_second", s->seconds > 0 ? (double)samples / s->seconds : NAN);
    put_count(rays, "camera", s->camera_rays);
    put_count(rays, "bounce", s->bounce_rays);
    put_count(rays, "shadow", s->shadow_rays);
    put(o, "rays", rays);
    put(o, "stages", stats_stages(s));
    put_number(o, "waiting_seconds", s->waiting_seconds);
    put(o, "error", error_facts(r));
    put(o, "discarded", discarded(s));
    put_number(o, "lost_energy", s->lost_energy >= 0 ? s->lost_energy : NAN);
    return o;
}

static json_t *ablation_facts(const job_run *r) {
    const job_ablation *a = &r->ablation;
    kiln_text names = {0};
    if (!a->removed) return json_null();
    json_t *o = json_object();
    effects_list(a->removed, &names);
    put_text(o, "removed", names.data);
    put_number(o, "difference", a->difference.known ? a->difference.root : NAN);
    put_number(o, "light", a->difference.known ? a->difference.light : NAN);
    put_number(o, "time", a->difference.known ? a->time : NAN);
    text_free(&names);
    return o;
}

json_t *stats_memory(const job_run *r) {
    json_t *o = json_object();
    put_count(o, "peak", machine_peak_memory());
    put_count(o, "film", r->film ? kiln_film_bytes(r->film) : 0);
    put_count(o, "acceleration", r->memory.acceleration);
    put_count(o, "scene", r->memory.scene);
    put_count(o, "textures", r->memory.textures);
    return o;
}

static json_t *layer_facts(const job_run *r) {
    json_t *array = json_array();
    kiln_text names = {0};
    layers_list(&r->options->layers, r->film, &names);
    for (const char *name = names.data; name && *name; name += strlen(name) + 1)
        (void)json_array_append_new(array, json_text_of(name));
    text_free(&names);
    return array;
}

static json_t *picture_facts(const job_run *r) {
    kiln_film_desc d = kiln_film_describe(r->film);
    json_t *o = json_object(), *crop = json_array();
    put_count(o, "width", d.width);
    put_count(o, "height", d.height);
    for (int i = 0; i < 4; i++) (void)json_array_append_new(crop, json_integer(d.crop[i]));
    put(o, "crop", crop);
    put_text(o, "color_config", kiln_color_describe(r->color));
    put_text(o, "color_view", kiln_view_describe(r->display));
    put_number(o, "exposure", r->exposure);
    put_bool(o, "exposure_chosen", r->exposure_chosen);
    put(o, "layers", layer_facts(r));
    return o;
}

static json_t *output_facts(const job_run *r) {
    json_t *array = json_array();
    for (uint32_t i = 0; i < r->outputs.count; i++) {
        json_t *o = json_object();
        put_text(o, "file", r->outputs.items[i].path);
        put_text(o, "format", output_format_name(r->outputs.items[i].path));
        put_bool(o, "written", r->outputs.items[i].written);
        (void)json_array_append_new(array, o);
    }
    return array;
}

json_t *stats_options(const job_options *o) {
    json_t *object = json_object();
    for (size_t i = 0; i < job_option_table.count; i++) {
        const option_row *row = &job_option_table.rows[i];
        kiln_text value = {0};
        if (!(o->given >> i & 1) || row->kind->repeats) continue;
        option_print(row, o, 0, &value);
        put_text(object, row->name, value.data);
        text_free(&value);
    }
    return object;
}

json_t *stats_make(const job_run *r) {
    json_t *o = json_object();
    double total = 0;
    char *command = r->source ? metadata_command(r) : NULL;
    for (uint32_t i = 0; i < r->phase_count; i++) total += r->phases[i].seconds;
    put_text(o, "command", command);
    free(command);
    put_text(o, "scene_file", r->source);
    put(o, "options", stats_options(r->options));
    put_number(o, "seconds", total);
    put(o, "phases", stats_phases(r));
    if (r->scene && r->view.name) put(o, "scene", scene_facts(r));
    if (r->rendered) {
        put(o, "picture", picture_facts(r));
        put(o, "render", render_facts(r));
        put(o, "effects", effects_facts(&r->plan));
        put(o, "ablation", ablation_facts(r));
    }
    put(o, "outputs", output_facts(r));
    put(o, "memory", stats_memory(r));
    put(o, "machine", stats_machine(r->options->threads));
    put(o, "versions", stats_versions());
    put(o, "notes", stats_messages(r->report, KILN_NOTE));
    put(o, "warnings", stats_messages(r->report, KILN_WARNING));
    put(o, "errors", stats_messages(r->report, KILN_ERROR));
    put_count(o, "exit_code", (uint64_t)run_exit_code(r));
    return o;
}
