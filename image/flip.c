/* image/flip.c: FLIP, after Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference
 * Evaluator for Alternating Images", 2020, and its extension to high dynamic range: Andersson, Nilsson, Shirley and
 * Akenine-Möller, "Visualizing Errors in Rendered High Dynamic Range Images", 2021. */
#include "image/flip.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/threads.h"

typedef struct color { float v[3]; } color;

/* Linear Rec.709 to CIE XYZ (IEC 61966-2-1), and back; white is what (1,1,1) becomes. */
static const float to_xyz[3][3] = {
    {0.4123908f, 0.3575843f, 0.1804808f}, {0.2126390f, 0.7151687f, 0.0721923f}, {0.0193308f, 0.1191948f, 0.9505322f}};
static const float from_xyz[3][3] = {
    {3.2409699f, -1.5373832f, -0.4986108f}, {-0.9692436f, 1.8759675f, 0.0415551f},
    {0.0556301f, -0.2039770f, 1.0569715f}};
static const float white[3] = {0.9504559f, 1.0f, 1.0890578f};

static color multiply(const float m[3][3], color c) {
    color out;
    for (int k = 0; k < 3; k++) out.v[k] = m[k][0] * c.v[0] + m[k][1] * c.v[1] + m[k][2] * c.v[2];
    return out;
}

/* The space in which eyes' sensitivity to contrast is known: CIELAB without its cube roots (section 4.1.1). */
static color linear_to_ycxcz(color rgb) {
    color n = multiply(to_xyz, rgb);
    for (int k = 0; k < 3; k++) n.v[k] /= white[k];
    return (color){{116 * n.v[1] - 16, 500 * (n.v[0] - n.v[1]), 200 * (n.v[1] - n.v[2])}};
}

static color ycxcz_to_linear(color c) {
    float y = (c.v[0] + 16) / 116;
    color xyz = {{(y + c.v[1] / 500) * white[0], y * white[1], (y - c.v[2] / 200) * white[2]}};
    return multiply(from_xyz, xyz);
}

/* CIELAB (CIE 15), with chroma weakened in the dark: the Hunt effect (section 4.1.2). */
static color linear_to_hunt_lab(color rgb) {
    const float bound = 6.0f / 29;
    color n = multiply(to_xyz, rgb);
    for (int k = 0; k < 3; k++) {
        float t = n.v[k] / white[k];
        n.v[k] = t > bound * bound * bound ? cbrtf(t) : t / (3 * bound * bound) + 4.0f / 29;
    }
    float l = 116 * n.v[1] - 16;
    return (color){{l, 0.01f * l * 500 * (n.v[0] - n.v[1]), 0.01f * l * 200 * (n.v[1] - n.v[2])}};
}

/* HyAB (Abasi et al. 2020), compressed: large differences are all large. */
static float color_distance(color a, color b) {
    float da = a.v[1] - b.v[1], db = a.v[2] - b.v[2];
    return powf(fabsf(a.v[0] - b.v[0]) + sqrtf(da * da + db * db), 0.7f);
}

/* The largest that sRGB has is between green and blue. */
static float largest_distance(void) {
    return color_distance(linear_to_hunt_lab((color){{0, 1, 0}}), linear_to_hunt_lab((color){{0, 0, 1}}));
}

/* Below 0.4 of the largest, distances take 0.95 of the range (section 4.1.3). */
static float spread(float distance, float largest) {
    const float knee = 0.4f * largest, share = 0.95f;
    return distance < knee ? share / knee * distance : share + (distance - knee) / (largest - knee) * (1 - share);
}

static color load(const float *planes, size_t count, size_t i) {
    return (color){{planes[i], planes[count + i], planes[2 * count + i]}};
}

static void save(float *planes, size_t count, size_t i, color c) {
    for (size_t k = 0; k < 3; k++) planes[k * count + i] = c.v[k];
}

/* Of one picture. */
typedef struct percept {
    float *planes;      /* linear, then YCxCz, at last Lab as it is seen from afar */
    flip_features features;
} percept;

typedef struct work {
    const flip_planes *p;
    percept image, reference;
    float *scratch, *map;
    float largest;
} work;

static bool perceive(const flip_planes *p, percept *s, float *scratch) {
    size_t count = (size_t)p->width * p->height;
    for (size_t i = 0; i < count; i++) save(s->planes, count, i, linear_to_ycxcz(load(s->planes, count, i)));
    for (size_t i = 0; i < count; i++) s->features.points[i] = (s->planes[i] + 16) / 116;
    memcpy(scratch + 2 * count, s->features.points, count * sizeof *scratch);
    return flip_detect(p, scratch + 2 * count, s->features, scratch) && flip_blur(p, s->planes, scratch);
}

static color seen(const percept *s, size_t count, size_t i) {
    color rgb = ycxcz_to_linear(load(s->planes, count, i));
    for (int k = 0; k < 3; k++) rgb.v[k] = fminf(fmaxf(rgb.v[k], 0), 1);
    return linear_to_hunt_lab(rgb);
}

static void judge_row(void *context, size_t y, uint32_t thread) {
    (void)thread;
    const work *w = context;
    size_t width = w->p->width, count = width * w->p->height;
    for (size_t i = y * width; i < (y + 1) * width; i++) {
        float hue = spread(color_distance(seen(&w->image, count, i), seen(&w->reference, count, i)), w->largest);
        float edges = fabsf(w->image.features.edges[i] - w->reference.features.edges[i]);
        float points = fabsf(w->image.features.points[i] - w->reference.features.points[i]);
        float feature = sqrtf(fmaxf(edges, points) * (float)M_SQRT1_2); /* both directions at once are √2 at most */
        w->map[i] = powf(hue, 1 - feature);                            /* section 4.3 */
    }
}

bool flip_of_linear(flip_planes *p, float *map) {
    enum { PLANES = 7 }; /* features of both, and three to work in */
    size_t count = (size_t)p->width * p->height;
    float *memory = array_alloc(count, PLANES * sizeof *memory);
    if (!memory) return false;
    work w = {.p = p, .map = map, .largest = largest_distance(), .scratch = memory + 4 * count,
              .image = {p->image, {memory, memory + count}},
              .reference = {p->reference, {memory + 2 * count, memory + 3 * count}}};
    bool done = perceive(p, &w.image, w.scratch) && perceive(p, &w.reference, w.scratch);
    if (done) threads_for(p->threads, p->height, judge_row, &w);
    free(memory);
    return done;
}

static bool make_planes(const kiln_comparison *c, flip_planes *p) {
    size_t count = (size_t)c->width * c->height;
    *p = (flip_planes){.width = c->width, .height = c->height, .threads = c->threads,
                       .pixels_per_degree = c->pixels_per_degree > 0 ? c->pixels_per_degree : 3840 * M_PI / 180};
    p->image = array_alloc(count, 6 * sizeof *p->image);
    if (p->image) p->reference = p->image + 3 * count;
    return p->image != NULL;
}

/* sRGB's curve (IEC 61966-2-1). */
static float decode(float v) {
    v = fminf(fmaxf(v, 0), 1);
    return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}

bool flip(const kiln_comparison *c, float *map) {
    size_t count = (size_t)c->width * c->height;
    flip_planes p;
    if (!make_planes(c, &p)) return false;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 3; k++) {
            p.image[k * count + i] = decode(c->image[3 * i + k]);
            p.reference[k * count + i] = decode(c->reference[3 * i + k]);
        }
    bool done = flip_of_linear(&p, map);
    free(p.image);
    return done;
}

/* Narkowicz's fit of the ACES filmic curve, 2016, of exposed values times 0.6: (a x² + b x)/(c x² + d x + e). */
static const double curve_a = 2.51 * 0.36, curve_b = 0.03 * 0.6, curve_c = 2.43 * 0.36, curve_d = 0.59 * 0.6,
                    curve_e = 0.14;

static float develop(float v, double scale) {
    double x = (double)v * scale, y = (curve_a * x * x + curve_b * x) / (curve_c * x * x + curve_d * x + curve_e);
    return (float)fmin(fmax(y, 0), 1);
}

/* The value that the curve takes to 0.85, which is bright and not yet clipped: a root of a quadratic. */
static double bright_value(void) {
    const double t = 0.85;
    double a = curve_a - t * curve_c, b = curve_b - t * curve_d, c = -t * curve_e;
    return (-b + sqrt(b * b - 4 * a * c)) / (2 * a);
}

static int by_value(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

typedef struct exposures {
    double first, step;
    int count;
} exposures;

static exposures choose_exposures(const kiln_comparison *c, float *luminance) {
    size_t count = (size_t)c->width * c->height;
    for (size_t i = 0; i < count; i++) {
        const float *v = c->reference + 3 * i;
        luminance[i] = to_xyz[1][0] * v[0] + to_xyz[1][1] * v[1] + to_xyz[1][2] * v[2];
    }
    qsort(luminance, count, sizeof *luminance, by_value);
    /* A black median, or a black picture, would ask for endless exposures. */
    double median = fmax((double)luminance[count / 2], (double)FLT_EPSILON);
    double most = fmax((double)luminance[count - 1], (double)FLT_EPSILON), first = log2(bright_value() / most);
    double last = log2(bright_value() / median);
    int steps = (int)fmax(2, ceil(last - first));
    return (exposures){first, (last - first) / (steps - 1), steps};
}

bool flip_hdr(const kiln_comparison *c, float *map) {
    size_t count = (size_t)c->width * c->height;
    flip_planes p;
    float *one = array_alloc(count, sizeof *one);
    bool done = make_planes(c, &p) && one;
    exposures e = {0};
    if (done) e = choose_exposures(c, one);
    for (size_t i = 0; i < count; i++) map[i] = 0;
    for (int n = 0; done && n < e.count; n++) {
        double scale = exp2(e.first + n * e.step);
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < 3; k++) {
                p.image[k * count + i] = develop(c->image[3 * i + k], scale);
                p.reference[k * count + i] = develop(c->reference[3 * i + k], scale);
            }
        done = flip_of_linear(&p, one);
        for (size_t i = 0; done && i < count; i++) map[i] = fmaxf(map[i], one[i]);
    }
    free(p.image);
    free(one);
    return done;
}
