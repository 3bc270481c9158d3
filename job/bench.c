#include "job/bench.h"

#include "base/clock.h"
#include "job/machine.h"
#include "job/stats.h"

/* The least of so many times stands for the scene: what others do on the machine only adds. */
enum { ROUNDS = 3, SPP = 16 };

bool bench_prepare(job_run *r, kiln_scene *scene) {
    r->scene = scene;
    r->owns_scene = true;
    return run_phase(r, "color") && run_color(r) && (scene || (run_phase(r, "import") && run_import(r))) &&
           run_phase(r, "frame") && run_camera(r) && run_phase(r, "subdivide") && run_subdivide(r) &&
           run_phase(r, "light") && run_light(r) && run_phase(r, "build") && run_build(r);
}

bool bench_draw(job_run *r, uint32_t spp, ray_tape *tapes, kiln_render_stats *stats) {
    kiln_film_destroy(r->film);
    r->film = NULL;
    if (!run_film(r)) return false;
    kiln_render_options options = run_render_options(r);
    options.spp = spp;
    options.noise = options.budget_seconds = 0;
    if (!render_recorded(r->renderer, &options, r->film, tapes, stats, r->report)) return false;
    if (stats->stop != KILN_STOP_CANCELLED) return true;
    return report_error(r->report, KILN_CODE_CANCELLED, NULL, NULL, "interrupted");
}

/* What was found. */
typedef struct findings {
    double first_sample; /* seconds from the start to a picture of one sample a pixel */
    uint64_t peak;       /* bytes, before rays were recorded */
    uint32_t spp;
    uint64_t samples;
    kiln_render_stats best;
    double seconds[ROUNDS];
    int rounds;
    bench_replay replay;
} findings;

static bool measure(job_run *r, findings *f) {
    kiln_render_stats stats;
    f->spp = r->options->spp ? r->options->spp : SPP;
    if (!run_phase(r, "first sample") || !bench_draw(r, 1, NULL, &stats)) return false;
    f->first_sample = clock_seconds() - r->started;
    if (!run_phase(r, "measure")) return false;
    for (; f->rounds < ROUNDS; f->rounds++) {
        if (!bench_draw(r, f->spp, NULL, &stats)) return false;
        f->seconds[f->rounds] = stats.seconds;
        if (!f->rounds || stats.seconds < f->best.seconds) f->best = stats;
        if (!f->rounds) f->samples = kiln_film_samples(r->film), f->peak = machine_peak_memory();
        if (!r->options->embree) continue;
        if (!f->rounds && !bench_record(r, f->spp, &stats, &f->replay)) return false;
        bench_replay_once(r, &f->replay);
    }
    return true;
}

static json_t *render_facts(const findings *f) {
    const kiln_render_stats *s = &f->best;
    json_t *o = json_object(), *rays = json_object();
    put_number(o, "seconds", s->seconds);
    put(o, "runs", json_numbers_of(f->seconds, ROUNDS));
    put_count(o, "samples", f->samples);
    put_number(o, "samples_per_second", (double)f->samples / s->seconds);
    put_count(rays, "camera", s->camera_rays);
    put_count(rays, "bounce", s->bounce_rays);
    put_count(rays, "shadow", s->shadow_rays);
    put(o, "rays", rays);
    put_number(o, "rays_per_second", (double)(s->camera_rays + s->bounce_rays + s->shadow_rays) / s->seconds);
    put(o, "stages", stats_stages(s));
    put_number(o, "waiting_seconds", s->waiting_seconds);
    return o;
}

static json_t *picture_facts(const job_run *r, uint32_t spp) {
    json_t *o = json_object();
    put_count(o, "width", r->view.width);
    put_count(o, "height", r->view.height);
    put_count(o, "samples_per_pixel", spp);
    return o;
}

static json_t *scene_facts(const job_run *r) {
    json_t *o = json_object();
    kiln_scene_counts c = kiln_scene_count(r->scene);
    put_count(o, "instances", c.instances);
    put_count(o, "triangles", c.triangles);
    put_count(o, "lights", c.lights);
    put_text(o, "light", lighting_describe(&r->lighting, r->options));
    return o;
}

static void describe(const job_run *r, const findings *f, json_t *o) {
    json_t *memory = stats_memory(r);
    put(o, "scene", scene_facts(r));
    put(o, "picture", picture_facts(r, f->spp));
    put(o, "phases", stats_phases(r));
    put_number(o, "first_sample_seconds", f->first_sample);
    put(o, "render", render_facts(f));
    if (f->replay.tapes) put(o, "embree", bench_replay_facts(&f->replay, &f->best, f->samples));
    put_count(memory, "peak", f->peak);
    put(o, "memory", memory);
}

/* What has been measured makes room. */
static void release(job_run *r) {
    kiln_film_destroy(r->film);
    kiln_renderer_destroy(r->renderer);
    kiln_scene_destroy(r->scene);
    r->film = NULL;
    r->renderer = NULL;
    r->scene = NULL;
}

bool bench(job_run *r, const char *scene_file, json_t **json) {
    findings f = {0};
    kiln_scene *scene = NULL;
    *json = json_object();
    put_text(*json, "scene_file", scene_file);
    put(*json, "options", stats_options(r->options));
    put(*json, "machine", stats_machine(r->options->threads));
    put(*json, "versions", stats_versions());
    bool done = bench_check_growth(r->options, r->report) &&
                (scene_file || bench_make_scene(BENCH_TRIANGLES, 1, 0, &scene, r->report)) && bench_prepare(r, scene) &&
                measure(r, &f);
    run_phase(r, NULL);
    if (done) describe(r, &f, *json);
    bench_replay_free(&f.replay);
    if (done && r->options->growth) {
        json_t *rows = NULL;
        release(r);
        done = bench_growth(r, scene_file, &rows);
        put(*json, "growth", rows);
    }
    put(*json, "warnings", stats_messages(r->report, KILN_WARNING));
    return done;
}
