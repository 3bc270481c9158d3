#include "image/icc.h"

#include <math.h>
#include <string.h>

/* ICC.1:2010 (4.3). Every number is big-endian; reals are s15Fixed16. */
typedef struct cursor {
    unsigned char *bytes;
    size_t at;
} cursor;

static void put32(cursor *c, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) c->bytes[c->at++] = (unsigned char)(value >> shift);
}
static void put_name(cursor *c, const char *name) {
    memcpy(c->bytes + c->at, name, 4);
    c->at += 4;
}
static void put_real(cursor *c, double value) { put32(c, (uint32_t)(int32_t)lround(value * 65536)); }
static void put_reals(cursor *c, const double *values, int count) {
    for (int i = 0; i < count; i++) put_real(c, values[i]);
}

static void put_text(cursor *c, const char *text) { /* multiLocalizedUnicodeType, ASCII in one language */
    size_t length = strlen(text);
    put_name(c, "mluc");
    put32(c, 0);
    put32(c, 1);
    put32(c, 12);
    put_name(c, "enUS");
    put32(c, (uint32_t)(2 * length));
    put32(c, 28);
    for (size_t i = 0; i < length; i++) {
        c->bytes[c->at++] = 0;
        c->bytes[c->at++] = (unsigned char)text[i];
    }
    while (c->at % 4) c->bytes[c->at++] = 0;
}

static void put_xyz(cursor *c, const double xyz[3]) {
    put_name(c, "XYZ ");
    put32(c, 0);
    put_reals(c, xyz, 3);
}

static void put_header(cursor *c) {
    static const double d50[3] = {0.9642, 1.0, 0.8249};
    c->at = 8; /* the size comes last */
    put32(c, 0x04300000);
    put_name(c, "mntr");
    put_name(c, "RGB ");
    put_name(c, "XYZ ");
    put32(c, 2026u << 16 | 1); /* a fixed date, 1 January: the same picture is the same file */
    put32(c, 1u << 16);
    put32(c, 0);
    put_name(c, "acsp");
    c->at = 64;
    put32(c, 1); /* relative colorimetric */
    put_reals(c, d50, 3);
    c->at = 128;
}

/* IEC 61966-2-1, adapted to D50 by Bradford's matrix, which chad holds. */
size_t image_icc_srgb(unsigned char bytes[IMAGE_ICC_SRGB_MAX]) {
    static const char *const names[] = {"desc", "cprt", "wtpt", "chad", "rXYZ", "gXYZ", "bXYZ", "rTRC", "gTRC", "bTRC"};
    static const double white[3] = {0.9642, 1.0, 0.8249}, red[3] = {0.43607, 0.22249, 0.01392},
                        green[3] = {0.38515, 0.71687, 0.09708}, blue[3] = {0.14307, 0.06061, 0.71410};
    static const double bradford[9] = {1.04788,  0.02292, -0.05022, 0.02959, 0.99048,
                                       -0.01707, -0.00925, 0.01508, 0.75168};
    static const double curve[5] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
    enum { TAGS = sizeof names / sizeof names[0], CURVE = 7 };
    size_t starts[TAGS + 1];
    memset(bytes, 0, IMAGE_ICC_SRGB_MAX);
    cursor c = {bytes, 128 + 4 + 12 * TAGS};
    for (int i = 0; i <= CURVE; i++) {
        starts[i] = c.at;
        switch (i) {
        case 0: put_text(&c, "sRGB"); break;
        case 1: put_text(&c, "No copyright, use freely"); break;
        case 2: put_xyz(&c, white); break;
        case 3:
            put_name(&c, "sf32");
            put32(&c, 0);
            put_reals(&c, bradford, 9);
            break;
        case 4: put_xyz(&c, red); break;
        case 5: put_xyz(&c, green); break;
        case 6: put_xyz(&c, blue); break;
        default:
            put_name(&c, "para");
            put32(&c, 0);
            put32(&c, 3u << 16); /* Y = (a X + b)^g from d on, c X below */
            put_reals(&c, curve, 5);
        }
    }
    size_t size = c.at;
    starts[CURVE + 1] = size;
    put_header(&c);
    put32(&c, TAGS);
    for (int i = 0; i < TAGS; i++) {
        int data = i < CURVE ? i : CURVE; /* the three channels share a curve */
        put_name(&c, names[i]);
        put32(&c, (uint32_t)starts[data]);
        put32(&c, (uint32_t)(starts[data + 1] - starts[data]));
    }
    c.at = 0;
    put32(&c, (uint32_t)size);
    return size;
}
