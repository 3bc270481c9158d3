#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "job/run.h"
#include "scene/scene.h"

bool run_start(job_run *r, const job_options *options, const kiln_job_events *events, const char *source,
               kiln_report *report) {
    *r = (job_run){.options = options, .events = events, .report = report, .started = clock_seconds()};
    r->source = strdup(source);
    r->asset_name = template_asset_name(source);
    if (!r->source || !r->asset_name) return report_no_memory(report, "starting a job");
    return job_rules_choose(options, &r->rules, report);
}

void run_free(job_run *r) {
    kiln_film_destroy(r->film);
    kiln_renderer_destroy(r->renderer);
    kiln_view_destroy(r->display);
    if (r->owns_scene) kiln_scene_destroy(r->scene);
    kiln_color_destroy(r->color);
    outputs_free(&r->outputs);
    free(r->subdivisions);
    free(r->view.name);
    free(r->source);
    free(r->asset_name);
    *r = (job_run){0};
}

bool run_phase(job_run *r, const char *name) {
    double now = clock_seconds();
    if (r->phase_count) r->phases[r->phase_count - 1].seconds += now - r->phase_started;
    r->phase_started = now;
    if (!name) return true;
    if (r->phase_count < JOB_PHASES_MAX) r->phases[r->phase_count++].name = name;
    if (r->events->phase) r->events->phase(name, r->events->user);
    if (r->events->cancel && *r->events->cancel && !r->rendered)
        return report_error(r->report, KILN_CODE_CANCELLED, NULL, NULL, "interrupted before there was a picture");
    return true;
}

void run_log(const job_run *r, const char *format, ...) {
    kiln_text line = {0};
    va_list args;
    va_start(args, format);
    text_format_list(&line, format, args);
    va_end(args);
    if (r->events->log && line.data) r->events->log(line.data, r->events->user);
    text_free(&line);
}

bool run_color(job_run *r) {
    const job_options *o = r->options;
    if (!kiln_color_create(&(kiln_color_options){o->ocio, o->working_space}, &r->color, r->report)) return false;
    r->exposure = o->exposure;
    kiln_view_options view = {o->display, o->view, o->look, o->exposure};
    return kiln_color_working_space(r->color, &r->decoding, r->report) &&
           kiln_view_create(r->color, &view, &r->display, r->report);
}

bool run_import(job_run *r) {
    r->owns_scene = true;
    kiln_import_options options = {.allow_outside = r->options->allow_outside};
    return kiln_import(r->source, &options, &r->scene, r->report);
}

bool run_camera(job_run *r) { return view_choose(r->options, r->scene, &r->view, r->report); }

/* A render never overwrites what it is made from. */
static bool spare_inputs(const job_run *r) {
    const job_options *o = r->options;
    const scene_source *source = &r->scene->source;
    const char *ocio = o->ocio ? o->ocio : getenv("OCIO");
    for (size_t i = 0; i < source->file_count; i++)
        if (!outputs_check_input(&r->outputs, o->stats, source->files[i], "the asset consists of", r->report))
            return false;
    return (!o->env || outputs_check_input(&r->outputs, o->stats, file_identify(o->env), "--env names", r->report)) &&
           (!ocio || outputs_check_input(&r->outputs, o->stats, file_identify(ocio), "colours come from", r->report));
}

bool run_outputs(job_run *r) {
    template_values values = {r->asset_name, r->view.name, "default", 0};
    const char *stats = r->options->stats;
    return outputs_plan(r->options, &values, &r->outputs, r->report) &&
           outputs_check_distinct(&r->outputs, stats, r->report) && spare_inputs(r) &&
           outputs_try(&r->outputs, stats, r->report);
}

bool run_subdivide(job_run *r) {
    const job_options *o = r->options;
    r->cage_triangles = kiln_scene_count(r->scene).triangles_unique;
    kiln_subdivide_options options = {.mode = o->subdivide.mode,
                                      .level = o->subdivide.level,
                                      .scheme = o->scheme,
                                      .crease_angle_rad = o->crease_angle_deg * M_PI / 180,
                                      .camera = &r->view.camera,
                                      .width = r->view.width,
                                      .height = r->view.height,
                                      .threads = o->threads};
    if (!kiln_subdivide(r->scene, &options, &r->subdivisions, &r->subdivision_count, r->report)) return false;
    view_reframe(o, r->scene, &r->view); /* limit surfaces are not where their cages are */
    return true;
}

bool run_light(job_run *r) {
    r->asset_images = r->scene->image_count;
    r->lighting = lighting_choose(r->options, r->scene);
    if (!lighting_apply(&r->lighting, r->options, &r->view.camera, r->scene, r->report) ||
        !kiln_scene_commit(r->scene, r->report) || (r->lighting.doubtful && !run_try_emitters(r)))
        return false;
    kiln_scene_counts c = kiln_scene_count(r->scene);
    run_log(r, "%s: %u instance%s of %u mesh%s, %llu triangle%s; camera %s, light %s", path_base(r->source),
            c.instances, c.instances == 1 ? "" : "s", c.meshes, c.meshes == 1 ? "" : "es",
            (unsigned long long)c.triangles, c.triangles == 1 ? "" : "s", r->view.name,
            lighting_describe(&r->lighting, r->options));
    if (r->color) run_log(r, "colours: %s", kiln_color_describe(r->color));
    return true;
}
