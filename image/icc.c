#include "image/icc.h"

#include <math.h>
#include <string.h>

#include "image/codec.h"

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

/* By the numbers of ITU-T H.273. Colorants are columns of RGB to XYZ, adapted from D65 to D50 by Bradford's matrix,
 * which chad holds. */
typedef struct primaries_row {
    uint8_t number;
    double red[3], green[3], blue[3];
} primaries_row;

static const primaries_row primaries_rows[] = {
    {1, {0.43607, 0.22249, 0.01392}, {0.38515, 0.71687, 0.09708}, {0.14307, 0.06061, 0.71410}},   /* ITU-R BT.709 */
    {12, {0.51512, 0.24120, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.15710, 0.06657, 0.78407}}, /* Display P3 */
};

/* A parametricCurveType: from what is stored to light. */
typedef struct transfer_row {
    uint8_t number;
    uint32_t function; /* 0: X^g; 3: (a X + b)^g from d on, c X below */
    int count;
    double parameters[5]; /* g a b c d */
} transfer_row;

static const transfer_row transfer_rows[] = {
    {1, 0, 1, {2.4}}, /* BT.709 is shown by BT.1886 */
    {13, 3, 5, {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045}}, /* IEC 61966-2-1 */
};

/* What programs list the profile as. */
static const char *name_of(uint8_t primaries, uint8_t transfer) {
    if (transfer == 1) return primaries == 1 ? "Rec.709, Rec.1886" : "Display P3, Rec.1886";
    return primaries == 1 ? "sRGB" : "Display P3";
}

static void put_curve(cursor *c, const transfer_row *t) {
    put_name(c, "para");
    put32(c, 0);
    put32(c, t->function << 16);
    put_reals(c, t->parameters, t->count);
}

static size_t write_profile(const primaries_row *p, const transfer_row *t, unsigned char *bytes) {
    static const char *const names[] = {"desc", "cprt", "wtpt", "chad", "rXYZ", "gXYZ", "bXYZ", "rTRC", "gTRC", "bTRC"};
    static const double white[3] = {0.9642, 1.0, 0.8249};
    static const double bradford[9] = {1.04788,  0.02292, -0.05022, 0.02959, 0.99048,
                                       -0.01707, -0.00925, 0.01508, 0.75168};
    enum { TAGS = sizeof names / sizeof names[0], CURVE = 7 };
    size_t starts[CURVE + 2];
    memset(bytes, 0, IMAGE_ICC_MAX);
    cursor c = {bytes, 128 + 4 + 12 * TAGS};
    for (int i = 0; i <= CURVE; i++) {
        starts[i] = c.at;
        switch (i) {
        case 0: put_text(&c, name_of(p->number, t->number)); break;
        case 1: put_text(&c, "No copyright, use freely"); break;
        case 2: put_xyz(&c, white); break;
        case 3:
            put_name(&c, "sf32");
            put32(&c, 0);
            put_reals(&c, bradford, 9);
            break;
        case 4: put_xyz(&c, p->red); break;
        case 5: put_xyz(&c, p->green); break;
        case 6: put_xyz(&c, p->blue); break;
        default: put_curve(&c, t);
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

size_t image_icc(const kiln_image_write_options *options, unsigned char bytes[IMAGE_ICC_MAX]) {
    const primaries_row *primaries = NULL;
    const transfer_row *transfer = NULL;
    uint8_t points[2];
    image_code_points(options, points);
    for (size_t i = 0; i < sizeof primaries_rows / sizeof *primaries_rows; i++)
        if (primaries_rows[i].number == points[0]) primaries = &primaries_rows[i];
    for (size_t i = 0; i < sizeof transfer_rows / sizeof *transfer_rows; i++)
        if (transfer_rows[i].number == points[1]) transfer = &transfer_rows[i];
    return primaries && transfer ? write_profile(primaries, transfer, bytes) : 0;
}
