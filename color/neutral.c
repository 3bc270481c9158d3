#include "color/neutral.h"

/* offset: x − 6.25 x² of the least channel x under 0.08, else 0.04
 * compressed = 1 − d² / (peak + d − start), of the largest channel after the offset, with d = 1 − start
 * grey = 1 − 1 / (desaturation (peak − compressed) + 1): how far to go to the grey of that peak */
static const float start = 0.8f - 0.04f, desaturation = 0.15f;

static float least(float a, float b) { return a < b ? a : b; }
static float largest(float a, float b) { return a > b ? a : b; }

void neutral_apply(float *rgb, size_t pixel_count) {
    const float d = 1 - start;
    for (size_t i = 0; i < pixel_count; i++, rgb += 3) {
        float r = largest(rgb[0], 0), g = largest(rgb[1], 0), b = largest(rgb[2], 0);
        float x = least(r, least(g, b));
        float offset = x < 0.08f ? x - 6.25f * x * x : 0.04f;
        r -= offset, g -= offset, b -= offset;
        float peak = largest(r, largest(g, b));
        float compressed = peak < start ? peak : 1 - d * d / (peak + d - start);
        float scale = peak < start ? 1 : compressed / peak;
        float grey = 1 - 1 / (desaturation * (peak - compressed) + 1);
        rgb[0] = r * scale + (compressed - r * scale) * grey;
        rgb[1] = g * scale + (compressed - g * scale) * grey;
        rgb[2] = b * scale + (compressed - b * scale) * grey;
    }
}
