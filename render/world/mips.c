#include "render/world/mips.h"

#include "base/arena.h"

int32_t mips_count(int32_t width, int32_t height) {
    int32_t count = 0;
    for (int32_t n = width > height ? width : height; n > 1; n /= 2) count++;
    return count;
}

bool mips_take(const float curve[256]) {
    for (int i = 0; i < 256; i++)
        if (!(curve[i] >= 0.0f && curve[i] <= 1.0f)) return false;
    return true;
}

/* Texel i of m covers [i, i + 1) n/m of n texels: from texel 2 i on so many, with these weights. */
static int cover(int32_t n, int32_t m, int32_t i, float weights[3]) {
    float share = 1.0f / (float)n;
    weights[0] = n == m ? 1.0f : n == 2 * m ? 0.5f : (float)(m - i) * share;
    weights[1] = n == 2 * m ? 0.5f : (float)m * share;
    weights[2] = (float)(i + 1) * share;
    return n == m ? 1 : n == 2 * m ? 2 : 3;
}

static void store(const texture_grid *to, int32_t x, int32_t y, const float value[4]) {
    size_t at = 4 * ((size_t)y * (size_t)to->width + (size_t)x);
    for (int k = 0; k < 4; k++) {
        if (to->format == KILN_PIXELS_F32) ((float *)(uintptr_t)to->texels)[at + (size_t)k] = value[k];
        else ((uint16_t *)(uintptr_t)to->texels)[at + (size_t)k] = (uint16_t)(fm_clamp(value[k], 0, 1) * 65535.0f + 0.5f);
    }
}

static void halve(const texture_grid *from, const texture_grid *to) {
    for (int32_t y = 0; y < to->height; y++) {
        float down[3];
        int rows = cover(from->height, to->height, y, down);
        for (int32_t x = 0; x < to->width; x++) {
            float across[3], sum[4] = {0};
            int columns = cover(from->width, to->width, x, across);
            for (int j = 0; j < rows; j++)
                for (int i = 0; i < columns; i++) {
                    texel c = texture_load(from, 2 * x + i, 2 * y + j);
                    float weight = down[j] * across[i];
                    sum[0] += weight * c.r, sum[1] += weight * c.g, sum[2] += weight * c.b, sum[3] += weight * c.a;
                }
            store(to, x, y, sum);
        }
    }
}

void *mips_make(const texture_grid *picture, size_t *bytes) {
    texture_grid from = *picture, to = texture_grid_above(picture, NULL);
    size_t texels = 0, size = to.format == KILN_PIXELS_F32 ? sizeof(float[4]) : sizeof(uint16_t[4]);
    for (texture_grid g = from; g.width > 1 || g.height > 1;) {
        g = texture_grid_above(&g, NULL);
        texels += (size_t)g.width * (size_t)g.height;
    }
    unsigned char *levels = aligned_array(texels ? texels : 1, size);
    *bytes = texels * size;
    for (unsigned char *at = levels; at && (from.width > 1 || from.height > 1); from = to) {
        to = texture_grid_above(&from, at);
        halve(&from, &to);
        at += size * (size_t)to.width * (size_t)to.height;
    }
    return levels;
}
