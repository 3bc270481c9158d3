#include "scene/transfer.h"

#include <math.h>
#include <string.h>

/* IEC 61966-2-1. */
static float srgb_decode(float code) {
    float c = fabsf(code);
    float linear = c <= 0.04045f ? c / 12.92f : powf((c + 0.055f) / 1.055f, 2.4f);
    return copysignf(linear, code);
}

float transfer_decode(kiln_transfer transfer, float code) {
    return transfer == KILN_TRANSFER_SRGB ? srgb_decode(code) : code;
}

void transfer_rec709(kiln_decoding *decoding) {
    memset(decoding, 0, sizeof *decoding);
    decoding->present = true;
    for (int t = 0; t < KILN_TRANSFER_COUNT; t++) {
        for (int code = 0; code < 256; code++)
            decoding->curve[t][code] = transfer_decode((kiln_transfer)t, (float)code / 255);
        for (int k = 0; k < 3; k++) decoding->matrix[t][4 * k] = 1;
    }
}
