#include "render/world/texture.h"

/* A coordinate brought into [0, 1] by the wrap mode; huge and non-finite ones, which have no digits left, to 0. */
static float wrap(kiln_wrap mode, float u) {
    u = fabsf(u) < 0x1p24f ? u : 0.0f;
    if (mode == KILN_WRAP_REPEAT) return u - fm_floor(u);
    if (mode == KILN_WRAP_CLAMP) return fm_clamp(u, 0.0f, 1.0f);
    float half = 0.5f * u, t = 2.0f * (half - fm_floor(half));
    return t > 1.0f ? 2.0f - t : t;
}

/* A neighbour that fell off the edge. */
static int32_t edge(kiln_wrap mode, int32_t i, int32_t n) {
    if (mode == KILN_WRAP_REPEAT) return i < 0 ? n - 1 : i >= n ? 0 : i;
    return i < 0 ? 0 : i >= n ? n - 1 : i;
}

static const void *texel_address(const texture_grid *t, int32_t x, int32_t y) {
    size_t at = (size_t)y * (size_t)t->width + (size_t)x;
    return (const unsigned char *)t->texels + texel_bytes(t->format) * at;
}

texel texture_load(const texture_grid *t, int32_t x, int32_t y) {
    const void *at = texel_address(t, x, y);
    if (t->format == KILN_PIXELS_U8) {
        const uint8_t *p = at;
        return (texel){t->curve[p[0]], t->curve[p[1]], t->curve[p[2]], (float)p[3] * (1.0f / 255.0f)};
    }
    if (t->format == KILN_PIXELS_U16) {
        const uint16_t *p = at;
        const float s = 1.0f / 65535.0f;
        return (texel){(float)p[0] * s, (float)p[1] * s, (float)p[2] * s, (float)p[3] * s};
    }
    const float *p = at;
    return (texel){p[0], p[1], p[2], p[3]};
}

/* One channel of it. */
static float load_channel(const texture_grid *t, int32_t x, int32_t y, uint32_t channel) {
    const void *at = texel_address(t, x, y);
    if (t->format == KILN_PIXELS_U8) {
        uint8_t value = ((const uint8_t *)at)[channel];
        return channel < 3 ? t->curve[value] : (float)value * (1.0f / 255.0f);
    }
    if (t->format == KILN_PIXELS_U16) return (float)((const uint16_t *)at)[channel] * (1.0f / 65535.0f);
    return ((const float *)at)[channel];
}

static texel mix(texel a, texel b, float t) {
    return (texel){a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b), a.a + t * (b.a - a.a)};
}

/* Level 0 is the picture. */
static void find_grid(const world_texture *t, int32_t level, texture_grid *g) {
    g->texels = t->texels;
    g->width = t->width, g->height = t->height;
    g->format = t->format;
    g->curve = t->curve;
    for (int32_t k = 0; k < level; k++)
        *g = texture_grid_above(g, k ? texel_address(g, 0, g->height) : t->levels);
}

int32_t texture_level(const world_texture *t, texture_footprint f) {
    if (!t->levels) return 0;
    /* In texels: A F Aᵀ, A = size · transform. */
    const float *m = t->transform, w = (float)t->width, h = (float)t->height;
    float a = w * m[0], b = w * m[1], c = h * m[3], d = h * m[4];
    float fx = f.xx * a + f.xy * b, fy = f.xy * a + f.yy * b, gx = f.xx * c + f.xy * d, gy = f.xy * c + f.yy * d;
    float squared = metric2_least((metric2){fx * a + fy * b, fx * c + fy * d, gx * c + gy * d});
    if (!(squared >= 16.0f)) return 0; /* also what is not a number */
    int32_t level = ((int32_t)(fm_bits(squared) >> 23) - 127) / 2 - 1; /* ⌊log₂(axis / 2)⌋ */
    return level < t->level_count ? level : t->level_count;
}

void texture_find(const world_texture *t, float u, float v, int32_t level, texture_tap *p) {
    const float *m = t->transform;
    texture_grid *g = &p->grid;
    find_grid(t, level, g);
    float x = wrap(t->wrap_u, m[0] * u + m[1] * v + m[2]) * (float)g->width;
    float y = wrap(t->wrap_v, m[3] * u + m[4] * v + m[5]) * (float)g->height;
    if (t->nearest) {
        int32_t i = (int32_t)x, j = (int32_t)y;
        p->i0 = p->i1 = i < g->width ? i : g->width - 1;
        p->j0 = p->j1 = j < g->height ? j : g->height - 1;
        p->fx = p->fy = 0.0f;
        return;
    }
    /* Texel centres lie at halves. */
    float xf = fm_floor(x - 0.5f), yf = fm_floor(y - 0.5f);
    int32_t i = (int32_t)xf, j = (int32_t)yf;
    p->fx = x - 0.5f - xf, p->fy = y - 0.5f - yf;
    p->i0 = edge(t->wrap_u, i, g->width), p->i1 = edge(t->wrap_u, i + 1, g->width);
    p->j0 = edge(t->wrap_v, j, g->height), p->j1 = edge(t->wrap_v, j + 1, g->height);
}

void texture_prefetch(const texture_tap *p) {
    __builtin_prefetch(texel_address(&p->grid, p->i0, p->j0));
    __builtin_prefetch(texel_address(&p->grid, p->i1, p->j1));
}

texel texture_read(const world_texture *t, const texture_tap *p) {
    const texture_grid *g = &p->grid;
    texel c = t->nearest ? texture_load(g, p->i0, p->j0)
                         : mix(mix(texture_load(g, p->i0, p->j0), texture_load(g, p->i1, p->j0), p->fx),
                               mix(texture_load(g, p->i0, p->j1), texture_load(g, p->i1, p->j1), p->fx), p->fy);
    if (!t->has_matrix) return c;
    vec3 rgb = v3_transform(t->matrix, v3(c.r, c.g, c.b));
    return (texel){rgb.x, rgb.y, rgb.z, c.a};
}

float texture_read_channel(const world_texture *t, const texture_tap *p) {
    const texture_grid *g = &p->grid;
    uint32_t k = t->channel;
    float a = load_channel(g, p->i0, p->j0, k);
    if (t->nearest) return a;
    float b = load_channel(g, p->i1, p->j0, k), c = load_channel(g, p->i0, p->j1, k), d = load_channel(g, p->i1, p->j1, k);
    float top = a + p->fx * (b - a), bottom = c + p->fx * (d - c);
    return top + p->fy * (bottom - top);
}

texel texture_sample_level(const world_texture *t, float u, float v, int32_t level) {
    texture_tap p;
    texture_find(t, u, v, level, &p);
    return texture_read(t, &p);
}
float texture_channel_level(const world_texture *t, float u, float v, int32_t level) {
    texture_tap p;
    texture_find(t, u, v, level, &p);
    return texture_read_channel(t, &p);
}

texel texture_sample(const world_texture *t, float u, float v) { return texture_sample_level(t, u, v, 0); }
float texture_channel(const world_texture *t, float u, float v) { return texture_channel_level(t, u, v, 0); }
