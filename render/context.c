#include "render/context.h"

#include <math.h>

#include "base/hash.h"
#include "render/path/medium.h"

/* What a program cannot have meant; NaN is refused with the rest. */
static const char *what_is_unknown(const kiln_render_options *o) {
    return (unsigned)o->estimator > KILN_ESTIMATOR_DOUBLED         ? "estimator"
           : (unsigned)o->roulette.kind > KILN_ROULETTE_THROUGHPUT ? "kind of roulette"
           : (unsigned)o->sampler > KILN_SAMPLER_INDEPENDENT       ? "sampler"
           : (unsigned)o->light_sampling > KILN_LIGHTS_UNIFORM     ? "choice of lights"
           : (unsigned)o->filter > KILN_PIXEL_BOX                  ? "pixel filter"
           : (unsigned)o->background > KILN_BACKGROUND_COLOR       ? "background"
                                                                   : NULL;
}

enum { FILTER_WIDTH_MAX = 64 }; /* a few pixels are a filter; past that, camera rays leave the picture's surroundings */

static bool is_amount(double v) { return v >= 0 && isfinite(v); }

static bool check_options(const kiln_render_options *o, kiln_report *report) {
    const char *unknown = what_is_unknown(o);
    const float *color = o->background_color;
    if (unknown)
        return report_error(report, KILN_CODE_USAGE, NULL, "give one of kiln/render.h", "the %s is not a known one",
                            unknown);
    if (o->roulette.kind == KILN_ROULETTE_FIXED && !(o->roulette.p > 0 && o->roulette.p <= 1))
        return report_error(report, KILN_CODE_USAGE, NULL, "give a probability above 0, at most 1",
                            "fixed roulette with the probability %g", o->roulette.p);
    if (o->spp > FIXED_SAMPLES_MAX)
        return report_error(report, KILN_CODE_USAGE, NULL, "give at most 16777216", "%u samples per pixel", o->spp);
    if (!is_amount(o->noise) || !is_amount(o->budget_seconds) || !is_amount(o->error_scale))
        return report_error(report, KILN_CODE_USAGE, NULL, "give finite numbers that are not negative",
                            "noise %g, budget %g s, error scale %g", o->noise, o->budget_seconds, o->error_scale);
    if (!(is_amount(o->filter_width) && o->filter_width <= FILTER_WIDTH_MAX))
        return report_error(report, KILN_CODE_USAGE, NULL, "give at most 64 pixels", "a filter %g pixels wide",
                            o->filter_width);
    if (!is_amount((double)color[0]) || !is_amount((double)color[1]) || !is_amount((double)color[2]))
        return report_error(report, KILN_CODE_USAGE, NULL, "give finite numbers that are not negative",
                            "the background colour %g, %g, %g", (double)color[0], (double)color[1], (double)color[2]);
    return true;
}

bool context_make(const kiln_renderer *r, const kiln_render_options *o, const kiln_film *film, path_context *c,
                         kiln_report *report) {
    const kiln_film_desc *d = &film->desc;
    const light_table *lights = &r->world->lights;
    const kiln_camera *view = o->camera ? o->camera : kiln_scene_camera(r->scene, 1);
    if (!check_options(o, report)) return false;
    if (!view)
        return report_error(report, KILN_CODE_USAGE, NULL, "give a camera", "the scene has no camera");
    bool by_place = o->estimator != KILN_ESTIMATOR_BSDF && o->light_sampling == KILN_LIGHTS_TREE && lights->tree;
    light_choice choice = o->estimator == KILN_ESTIMATOR_BSDF        ? CHOOSE_POINTS
                          : o->light_sampling == KILN_LIGHTS_UNIFORM ? CHOOSE_UNIFORMLY
                          : by_place                                 ? CHOOSE_FAR
                                                                     : CHOOSE_BY_POWER;
    kiln_effect_plan plan = r->world->plan;
    scan_camera(r->scene, view, &plan);
    *c = (path_context){.world = r->world,
                        .effects = plan.runs,
                        .width = d->width,
                        .height = d->height,
                        .seed = hash_u64(o->seed),
                        .independent = o->sampler == KILN_SAMPLER_INDEPENDENT,
                        .estimator = o->estimator,
                        .roulette = o->roulette.kind,
                        .roulette_p = (float)o->roulette.p,
                        .roulette_min = o->roulette.min_depth,
                        .samples_lights = by_place || lights->any[choice],
                        .keeps_place = by_place || (o->estimator == KILN_ESTIMATOR_MIS && HAS(plan.runs, AREA_LIGHTS)),
                        .light_tree = by_place ? lights->tree : NULL,
                        .light_cdf = lights->cdf[choice],
                        .light_guide = lights->guide[choice],
                        .max_depth = o->max_depth == KILN_DEPTH_ZERO ? 0 : o->max_depth ? o->max_depth : 64,
                        .background = o->background,
                        .background_color = v3_load(o->background_color),
                        .aovs = d->aovs & FILM_SUMMED_AOVS,
                        .handles = d->mattes || d->aovs & (1u << KILN_AOV_OBJECT | 1u << KILN_AOV_MATERIAL)};
    pixel_filter_make(&c->filter, o->filter, o->filter_width);
    if (!camera_make(r->world, view, d->width, d->height, &c->camera, report)) return false;
    c->media = camera_media(r->world, &c->camera);
    float n = r->world->media[medium_top(c->media)].ior;
    c->squeeze = n * n;
    return true;
}
