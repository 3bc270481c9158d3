#include "render/path/lanes.h"
#include "render/path/medium.h"
#include "render/path/stages.h"
#include "render/world/lookup.h"

KERNEL void write_albedo(unsigned mask, batch *b, lane_range lanes) {
    const path_state *s = batch_state(b);
    path_output *o = &b->out;
    for (uint32_t i = lanes.first; i < lanes.end; i++) {
        shading p = lane_shading(mask, s, &b->scratch, i);
        vec3 a = bsdf_albedo(mask, &p.bsdf);
        uint32_t slot = slot_index(s->slot[i]);
        o->albedo[0][slot] = a.x, o->albedo[1][slot] = a.y, o->albedo[2][slot] = a.z;
    }
}

/* Double on the way: the scene's origin may be far from it. */
static void write_places(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    const path_scratch *x = &b->scratch;
    path_output *o = &b->out;
    dvec3 center = c->world->center;
    double metres = 1.0 / c->world->scale;
    for (uint32_t i = 0; i < b->n; i++) {
        uint32_t slot = slot_index(s->slot[i]);
        o->position[0][slot] = (float)(center.x + (double)x->px[i] * metres);
        o->position[1][slot] = (float)(center.y + (double)x->py[i] * metres);
        o->position[2][slot] = (float)(center.z + (double)x->pz[i] * metres);
        o->uv[0][slot] = x->tu[i], o->uv[1][slot] = x->tv[i];
    }
}

static void write_handles(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    const path_hit *h = batch_hit(b);
    for (uint32_t i = 0; i < b->n; i++) {
        uint32_t slot = slot_index(s->slot[i]);
        b->out.object[slot] = lookup_object(c->world, h->triangle[i], h->instance[i]);
        b->out.material[slot] = b->scratch.material[i];
    }
}

void STAGE(aovs)(const path_context *c, batch *b) {
    const path_state *s = batch_state(b);
    const path_scratch *x = &b->scratch;
    path_output *o = &b->out;
    vec3 axis = v3_neg(c->camera.back);
    float metres = (float)(1.0 / c->world->scale);
    for (uint32_t i = 0; i < b->n; i++) {
        uint32_t slot = slot_index(s->slot[i]);
        o->normal[0][slot] = x->nx[i], o->normal[1][slot] = x->ny[i], o->normal[2][slot] = x->nz[i];
        vec3 from = v3_sub(v3(x->px[i], x->py[i], x->pz[i]), c->camera.origin);
        o->depth[slot] = v3_dot(from, axis) * metres;
    }
    if (c->handles) write_handles(c, b);
    if (c->aovs & (1u << KILN_AOV_POSITION | 1u << KILN_AOV_UV)) write_places(c, b);
    if (!(c->aovs & 1u << KILN_AOV_ALBEDO)) return;
#define WRITE_ALBEDO(kernel, mask) write_albedo(mask, b, b->kinds[KIND_##kernel]);
    BSDF_KERNELS(WRITE_ALBEDO)
#undef WRITE_ALBEDO
    for (uint32_t i = b->surfaces; i < b->n; i++) {
        const float *albedo = c->world->albedo + 3 * (size_t)medium_top(s->media[i]);
        for (int k = 0; k < 3; k++) o->albedo[k][slot_index(s->slot[i])] = albedo[k];
    }
}
