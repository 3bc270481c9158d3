#include "job/bench.h"
#include "job/machine.h"

/* Memory that rays may take: a few million of them, and never an eighth of the machine. */
static double budget(void) {
    double most = 512e6, machine = (double)machine_memory();
    return machine > 0 && machine / 8 < most ? machine / 8 : most;
}

bool bench_record(job_run *r, uint32_t spp, const kiln_render_stats *plain, bench_replay *p) {
    /* Packets are not all full, and each thread must hold whole batches. */
    double rays = (double)(plain->camera_rays + plain->bounce_rays + plain->shadow_rays), room = 4096;
    p->count = renderer_threads(r->renderer);
    double packets = 2 * rays / 16 + room * p->count;
    double most = fmax(budget() / (double)tape_packet_bytes(), room * p->count);
    p->tapes = tapes_create(p->count, (size_t)fmin(packets, most), (uint64_t)ceil(packets / most));
    if (!p->tapes) return report_no_memory(r->report, "recording rays");
    kiln_render_stats recorded;
    if (!bench_draw(r, spp, p->tapes, &recorded)) return false;
    p->totals = tapes_count(p->tapes, p->count);
    p->differing = renderer_compare(r->renderer, p->tapes);
    if (p->differing)
        report_warning(r->report, KILN_CODE_INTERNAL, NULL, NULL,
                       "%llu rays met something else when they were replayed", (unsigned long long)p->differing);
    return true;
}

void bench_replay_once(const job_run *r, bench_replay *p) {
    double seconds = renderer_replay(r->renderer, p->tapes);
    if (!(p->seconds > 0) || seconds < p->seconds) p->seconds = seconds;
}

void bench_replay_free(bench_replay *p) {
    tapes_destroy(p->tapes, p->count);
    *p = (bench_replay){0};
}

json_t *bench_replay_facts(const bench_replay *p, const kiln_render_stats *plain, uint64_t samples) {
    const tape_totals *t = &p->totals;
    json_t *o = json_object(), *rays = json_object();
    double all = (double)(t->closest_rays + t->occlusion_rays), rate = (double)t->samples / p->seconds;
    put_number(o, "seconds", p->seconds);
    put_count(o, "samples", t->samples);
    put_number(o, "samples_per_second", rate);
    put_count(rays, "closest", t->closest_rays);
    put_count(rays, "occlusion", t->occlusion_rays);
    put(o, "rays", rays);
    put_number(o, "rays_per_second", all / p->seconds);
    put_count(o, "packets", t->packets);
    put_number(o, "packet_rays", all / (double)t->packets);
    put_count(o, "differing_rays", p->differing);
    put_number(o, "render_share", (double)samples / plain->seconds / rate);
    return o;
}
