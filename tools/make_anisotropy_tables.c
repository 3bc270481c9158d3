/* tools/make_anisotropy_tables.c: prints render/bsdf/anisotropy_table.c, in double, from the isotropic tables.
 *
 *     cc -O2 -I. tools/make_anisotropy_tables.c render/bsdf/albedo_table.c -lm -o make_anisotropy_tables &&
 *         ./make_anisotropy_tables > render/bsdf/anisotropy_table.c
 */
#include "render/bsdf/anisotropy.h"

/* What integrates the isotropic ones serves here too. */
int make_albedo_tables(void);
#pragma push_macro("main")
#undef main
#define main make_albedo_tables
#include "tools/make_albedo_tables.c"
#pragma pop_macro("main")

typedef struct { double x, y; } alphas;

static double lambda_of(dir v, alphas a) {
    double x = a.x * v.x, y = a.y * v.y;
    return 0.5 * (sqrt(1 + (x * x + y * y) / (v.z * v.z)) - 1);
}

/* What one scattering event returns, and how much of it goes with (1 − cos)^5. */
typedef struct { double full, schlick; } returned;

static returned anisotropic_albedo(dir wo, alphas a) {
    enum { N = 1 << 13 };
    returned sum = {0, 0};
    double lo = lambda_of(wo, a);
    dir s = unit((dir){wo.x * a.x, wo.y * a.y, wo.z});
    for (int i = 0; i < N; i++) { /* visible normals, as visible_normal has them */
        double u = fmod(0.5 + i * 0.6180339887498949, 1.0), v = (i + 0.5) / N;
        double phi = 2 * M_PI * u, z = (1 - v) * (1 + s.z) - s.z, r = sqrt(fmax(0, 1 - z * z));
        dir h = plus((dir){r * cos(phi), r * sin(phi), z}, s);
        h = unit((dir){h.x * a.x, h.y * a.y, fmax(h.z, 0)});
        double c = dot(wo, h);
        dir wr = plus(scaled(h, 2 * c), scaled(wo, -1));
        double weight = wr.z > 0 ? (1 + lo) / (1 + lo + lambda_of(wr, a)) / N : 0;
        sum.full += weight;
        sum.schlick += weight * pow(1 - c, 5);
    }
    return sum;
}

/* αy/αx at a coordinate: the inverse of anisotropy_ratio_at. */
static double ratio_at(int i, int n) {
    double root = 1 - (double)i / (n - 1), least = (double)ANISOTROPY_LEAST_RATIO;
    return least + (1 - least) * root * root;
}
static double alpha_at(int i, int n) { return fmax(pow((double)i / (n - 1), 2), (double)ANISOTROPY_LEAST_ALPHA); }

/* The direction whose stretched cosine is mu, at an azimuth's coordinate (anisotropy_stretch), bisected. */
static dir unstretched(double mu, double turn, double ratio) {
    double low = 0, high = 1, sine = sqrt(1 - mu * mu);
    for (int i = 0; i < 50; i++) {
        double q = 0.5 * (low + high), at = 0.5 * (q + q / (q + ratio * ratio * (1 - q)));
        *(at < turn ? &low : &high) = q;
    }
    double x2 = low / (low + ratio * ratio * (1 - low)); /* of the stretched direction */
    return unit((dir){sine * sqrt(x2), sine * sqrt(1 - x2) / ratio, mu});
}

/* What the isotropic tables say, as bsdf_see asks them. */
typedef struct { double loss, cosine; } said;

static said isotropic(double mu, double length, alphas a) {
    double alpha = sqrt(0.5 * (a.x * a.x + a.y * a.y));
    albedo_node roughness = albedo_roughness_node((float)sqrt(alpha));
    double cosine = length * (double)albedo_schlick_cosine((float)mu, (float)alpha, roughness);
    return (said){1 - (double)albedo_full((float)mu, (float)alpha, roughness), cosine};
}

static int32_t entry(int ratio, int alpha, int turn, int column) {
    if (ratio == 0) return 8192 << 16 | 8192;
    double r = ratio_at(ratio, ANISOTROPY_RATIOS), x = alpha_at(alpha, ANISOTROPY_ALPHAS);
    alphas a = {x, x * r};
    /* Losses vanish at the horizon; their quotient has a limit. */
    double mu = fmax(cosine_at((double)column / (ANISOTROPY_COSINES - 1), x), 1e-3 * x);
    dir w = unstretched(mu, (double)turn / (ANISOTROPY_TURNS - 1), r);
    returned e = anisotropic_albedo(w, a);
    said s = isotropic(mu, w.z / mu, a);
    double loss = (1 - e.full) / fmax(s.loss, 1e-5), cosine = (1 - pow(e.schlick / e.full, 0.2)) / s.cosine;
    double unit_of = (double)ANISOTROPY_UNIT;
    return (int32_t)(fmin(loss, 3.9) / unit_of + 0.5) | (int32_t)(fmin(cosine, 3.9) / unit_of + 0.5) << 16;
}

static int32_t made[ANISOTROPY_SIZE];

/* The mean loss of look-ups over the hemisphere, cosine-weighted: midpoints, cosines evenly over their logarithm, azimuths
 * by a tangent between the real one and the stretched. */
static double mean_loss(alphas a) {
    enum { COSINES = 200, AZIMUTHS = 48 };
    double sum = 0, least = 0.02 * a.x, octaves = log1p(1 / least);
    anisotropy_node where = anisotropy_make((float)a.x, (float)a.y);
    for (int i = 0; i < COSINES; i++) {
        double shifted = least * exp((i + 0.5) / COSINES * octaves), mu = shifted - least, sine = sqrt(1 - mu * mu);
        double before = 0, root = sqrt(a.y / a.x);
        for (int j = 0; j < AZIMUTHS; j++) {
            double even = 0.5 * M_PI * (j + 1) / AZIMUTHS, to = j + 1 < AZIMUTHS ? atan(tan(even) / root) : even;
            double phi = 0.5 * (before + to);
            vec3 w = {(float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)mu};
            anisotropy_direction d = anisotropy_stretch(w, where.stretch);
            double factor = (double)anisotropy_look_up(made, &where, d, (float)a.x).loss;
            double loss = isotropic((double)d.mu, 1, a).loss * factor;
            sum += loss * 2 * mu * shifted * octaves / COSINES * (to - before) / (0.5 * M_PI);
            before = to;
        }
    }
    return sum;
}

int main(void) {
    printf("/* Printed by tools/make_anisotropy_tables.c. */\n#include \"render/bsdf/anisotropy.h\"\n");
    begin("const int32_t anisotropy_table[ANISOTROPY_SIZE]");
    for (int i = 0, at = 0; i < ANISOTROPY_RATIOS; i++)
        for (int j = 0; j < ANISOTROPY_ALPHAS; j++)
            for (int k = 0; k < ANISOTROPY_TURNS; k++)
                for (int l = 0; l < ANISOTROPY_COSINES; l++, at++) {
                    made[at] = entry(i, j, k, l);
                    printf("%s0x%08x,", at % 8 ? " " : at ? "\n    " : "    ", (unsigned)made[at]);
                }
    end();
    begin("const float anisotropy_mean_table[ANISOTROPY_MEAN_ALPHAS * ANISOTROPY_MEAN_RATIOS]");
    for (int i = 0; i < ANISOTROPY_MEAN_RATIOS; i++)
        for (int j = 0; j < ANISOTROPY_MEAN_ALPHAS; j++) {
            double x = alpha_at(j, ANISOTROPY_MEAN_ALPHAS), y = x * ratio_at(i, ANISOTROPY_MEAN_RATIOS);
            double root = sqrt(sqrt(0.5 * (x * x + y * y)));
            put(i ? mean_loss((alphas){x, y}) / (double)albedo_full_mean_loss(albedo_roughness_node((float)root)) : 1);
        }
    end();
    return 0;
}
