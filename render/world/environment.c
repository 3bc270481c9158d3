#include "render/world/environment.h"

#include <stdlib.h>
#include <string.h>

#include "render/world/images.h"
#include "scene/transfer.h"

/* Radiance of every texel; what is not a radiance (negative, NaN, infinite, beyond the limit) is 0. */
static bool load(environment *e, kiln_arena *arena, const kiln_scene *scene, const kiln_decoding *decoding,
                 kiln_report *report) {
    const kiln_environment *from = &scene->environment;
    uint32_t width = 1, height = 1;
    float one[3] = {1, 1, 1}, *rgb = one;
    kiln_where where = where_root("environment");
    if (from->image) {
        if (!image_load_linear(scene_image(scene, from->image), from->transfer, decoding, &width, &height, &rgb, report))
            return false;
    }
    float color[3];
    v3_store(color, decoding_apply(decoding, KILN_TRANSFER_LINEAR, from->color));
    size_t count = (size_t)width * height;
    e->texels = ARENA_ARRAY(arena, float, 4 * count);
    size_t bad = 0;
    for (size_t i = 0; e->texels && i < 3 * count; i++) {
        float value = rgb[i] * color[i % 3];
        if (!(value >= 0 && value < RADIANCE_LIMIT)) value = 0, bad++;
        e->texels[i / 3 * 4 + i % 3] = value;
    }
    if (bad)
        report_warning(report, KILN_CODE_RANGE, &where, "clean the picture",
                       "values of the environment are negative, not finite or beyond 1e30: they count as black");
    if (rgb != one) free(rgb);
    e->width = (int32_t)width;
    e->height = (int32_t)height;
    return e->texels || report_no_memory(report, "building the environment");
}

static float brightness(const environment *e, int32_t x, int32_t y) {
    x = x < 0 ? x + e->width : x >= e->width ? x - e->width : x;
    y = y < 0 ? 0 : y >= e->height ? e->height - 1 : y;
    const float *t = e->texels + 4 * ((size_t)y * (size_t)e->width + (size_t)x);
    return (t[0] + t[1] + t[2]) * (1.0f / 3.0f);
}

/* Mean over a texel's cell of the bilinear look-up: (1, 6, 1)/8 either way. Zero only where every look-up is. */
static float cell_mean(const environment *e, int32_t x, int32_t y) {
    float sum = 0;
    for (int32_t j = -1; j <= 1; j++)
        for (int32_t i = -1; i <= 1; i++) sum += brightness(e, x + i, y + j) * (i ? 1.0f : 6.0f) * (j ? 1.0f : 6.0f);
    return sum * (1.0f / 64.0f);
}

/* Solid angle of a texel of row y: Δφ (cos θ_top − cos θ_bottom). */
static double texel_angle(const environment *e, int32_t y) {
    double top = cos(M_PI * y / e->height), bottom = cos(M_PI * (y + 1) / e->height);
    return 2 * M_PI / e->width * (top - bottom);
}

/* Distributions over rows and, within each, over texels; then the density of every texel as it will be drawn. */
static bool build_distribution(environment *e, kiln_arena *arena) {
    uint32_t w = (uint32_t)e->width, h = (uint32_t)e->height;
    e->row_cdf = ARENA_ARRAY(arena, uint32_t, (size_t)h + 1);
    e->row_guide = ARENA_ARRAY(arena, uint32_t, h);
    e->texel_cdf = ARENA_ARRAY(arena, uint32_t, (size_t)(w + 1) * h);
    e->texel_guide = ARENA_ARRAY(arena, uint32_t, (size_t)w * h);
    float *row = array_alloc(w, sizeof *row), *rows = array_alloc(h, sizeof *rows);
    if (!e->row_cdf || !e->row_guide || !e->texel_cdf || !e->texel_guide || !row || !rows) {
        free(row);
        free(rows);
        return false;
    }
    double total = 0;
    for (uint32_t y = 0; y < h; y++) {
        double sum = 0;
        for (uint32_t x = 0; x < w; x++) sum += (double)(row[x] = cell_mean(e, (int32_t)x, (int32_t)y));
        rows[y] = (float)(sum * texel_angle(e, (int32_t)y));
        total += sum * texel_angle(e, (int32_t)y);
        if (sum > 0) distribution_build(row, w, e->texel_cdf + (size_t)y * (w + 1), e->texel_guide + (size_t)y * w);
    }
    e->total = (float)total;
    if (total > 0) {
        distribution_build(rows, h, e->row_cdf, e->row_guide);
        for (uint32_t y = 0; y < h; y++)
            for (uint32_t x = 0; x < w; x++)
                e->texels[4 * ((size_t)y * w + x) + 3] =
                    (float)((double)distribution_probability(e->row_cdf, y) *
                            (double)distribution_probability(e->texel_cdf + (size_t)y * (w + 1), x) /
                            texel_angle(e, (int32_t)y));
    }
    free(row);
    free(rows);
    return true;
}

bool environment_build(world *w, const kiln_scene *scene, const kiln_decoding *decoding, kiln_report *report) {
    environment *e = &w->lights.environment;
    if (!load(e, &w->arena, scene, decoding, report)) return false;
    e->rotation_turns = to_turns(scene->environment.rotation_rad);
    if (!build_distribution(e, &w->arena)) return report_no_memory(report, "building the environment");
    e->present = e->total > 0;
    if (!e->present) plan_dismiss(&w->plan, KILN_EFFECT_ENVIRONMENT);
    return true;
}
