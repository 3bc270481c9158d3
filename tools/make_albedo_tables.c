/* tools/make_albedo_tables.c: prints render/bsdf/albedo_table.c: directional albedos of GGX interfaces
 * and of sheen, in double.
 *
 *     cc -O2 -I. tools/make_albedo_tables.c -lm -o make_albedo_tables && ./make_albedo_tables > render/bsdf/albedo_table.c
 *
 * Each entry of an interface is the mean of single-scattering weights over visible normals (Heitz 2018), on a rank-1
 * lattice; sheen's are midpoint sums over directions. */
#include <math.h>
#include <stdio.h>

#include "render/bsdf/albedo.h"

typedef struct { double x, y, z; } dir;

static double dot(dir a, dir b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static dir scaled(dir a, double s) { return (dir){a.x * s, a.y * s, a.z * s}; }
static dir plus(dir a, dir b) { return (dir){a.x + b.x, a.y + b.y, a.z + b.z}; }
static dir unit(dir a) { return scaled(a, 1 / sqrt(dot(a, a))); }

/* Smith's Lambda of GGX (Heitz 2014, eq. 72). */
static double lambda(dir v, double alpha) {
    double tan2 = (v.x * v.x + v.y * v.y) / (v.z * v.z);
    return 0.5 * (sqrt(1 + alpha * alpha * tan2) - 1);
}

/* Visible normal by spherical caps (Dupuy and Benyoub 2023). */
static dir visible_normal(dir wo, double alpha, double u, double v) {
    dir s = unit((dir){wo.x * alpha, wo.y * alpha, wo.z});
    double phi = 2 * M_PI * u, z = (1 - v) * (1 + s.z) - s.z, r = sqrt(fmax(0, 1 - z * z));
    dir h = plus((dir){r * cos(phi), r * sin(phi), z}, s);
    return unit((dir){h.x * alpha, h.y * alpha, fmax(h.z, 0)});
}

static double fresnel(double c, double eta) {
    double g2 = eta * eta - 1 + c * c;
    if (g2 < 0) return 1;
    double g = sqrt(g2);
    if (g + c == 0) return 1;
    double a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);
    return 0.5 * a * a * (1 + b * b);
}

typedef enum { FULL, SCHLICK, INTERFACE } what;

/* The weight of one visible normal: how much leaves after one scattering event. */
static double weight(what w, dir wo, dir h, double alpha, double eta) {
    double c = dot(wo, h), lo = lambda(wo, alpha);
    dir wr = plus(scaled(h, 2 * c), scaled(wo, -1));
    double reflected = wr.z > 0 ? (1 + lo) / (1 + lo + lambda(wr, alpha)) : 0;
    if (w == FULL) return reflected;
    if (w == SCHLICK) return reflected * pow(1 - c, 5);
    double f = fresnel(c, eta), k = 1 - (1 - c * c) / (eta * eta);
    if (k < 0) return reflected * f;
    dir wt = plus(scaled(wo, -1 / eta), scaled(h, c / eta - sqrt(k)));
    /* The two sides of a refraction shadow independently (Walter et al. 2007). */
    double transmitted = wt.z < 0 ? 1 / (1 + lambda(wt, alpha)) : 0;
    return reflected * f + transmitted * (1 - f);
}

static double albedo(what w, double mu, double alpha, double eta) {
    enum { N = 1 << 14 };
    mu = fmin(fmax(mu, 1e-7), 1);
    dir wo = {sqrt(1 - mu * mu), 0, mu};
    double sum = 0;
    for (int i = 0; i < N; i++) {
        double u = (i + 0.5) / N, v = fmod(0.5 + i * 0.6180339887498949, 1.0);
        sum += weight(w, wo, visible_normal(wo, alpha, v, u), alpha, eta);
    }
    return sum / N;
}

/* cos θ at a coordinate t: the inverse of albedo_cosine_at, bisected. */
static double cosine_at(double t, double alpha) {
    double low = 0, high = 1, share = (double)ALBEDO_COSINE_SHARE;
    for (int i = 0; i < 60; i++) {
        double mu = 0.5 * (low + high), there = (1 - share) * sqrt(mu * (1 + alpha) / (mu + alpha)) + share * mu;
        *(there < t ? &low : &high) = mu;
    }
    return 0.5 * (low + high);
}
static double column_mu(int i, double alpha) { return cosine_at((double)i / (ALBEDO_COSINES - 1), alpha); }

/* What the table of Schlick's share holds. */
static double schlick_relative(double mu, double alpha) {
    double share = albedo(SCHLICK, mu, alpha, 1) / albedo(FULL, mu, alpha, 1);
    return (1 - pow(share, 0.2)) / (mu + alpha);
}

/* As the table holds it: losses must be those of the very entries. */
static double rounded(double value) { return round(value * 1e5) * 1e-5; }

static int printed; /* of the numbers of a table */
static void begin(const char *declaration) {
    printf("\n%s = {\n", declaration);
    printed = 0;
}
static void put(double value) {
    printf("%s%.5ff,", printed % 12 ? " " : printed ? "\n    " : "    ", value);
    printed++;
}
/* Mean losses need digits of their own, however small they are. */
static void put_loss(double value) {
    printf("%s%.6ef,", printed % 8 ? " " : printed ? "\n    " : "    ", value);
    printed++;
}
static void end(void) { printf("\n};\n"); }

/* 2 ∫ E(mu) mu dmu over one row of nodes, E linear in t as the look-up has it; times Schlick's share, unless that row is
 * NULL. By midpoints. */
static double mean_of_row(const double *row, const double *schlick, double alpha) {
    enum { STEPS = 16 };
    double sum = 0, before = 0;
    for (int i = 0; i + 1 < ALBEDO_COSINES; i++)
        for (int k = 1; k <= STEPS; k++) {
            double f = (k - 0.5) / STEPS, value = row[i] + f * (row[i + 1] - row[i]);
            double mu = cosine_at((i + (double)k / STEPS) / (ALBEDO_COSINES - 1), alpha);
            if (schlick) {
                double middle = cosine_at((i + f) / (ALBEDO_COSINES - 1), alpha);
                value *= pow(1 - (schlick[i] + f * (schlick[i + 1] - schlick[i])) * (middle + alpha), 5);
            }
            sum += value * (mu * mu - before * before);
            before = mu;
        }
    return sum;
}

/* What a table of losses holds at a finer row j: 1 less the mean of look-ups between the rows of E, over roughness. Row 0
 * is that of the first roughness above 0: under 0.01 lobes are mirrors. */
static double relative_loss(double rows[][ALBEDO_COSINES], int j) {
    double at = (double)(j > 0 ? j : 1) / ALBEDO_FINER, r = at / (ALBEDO_ROUGHNESS - 1), between[ALBEDO_COSINES];
    int low = at < ALBEDO_ROUGHNESS - 2 ? (int)at : ALBEDO_ROUGHNESS - 2;
    for (int i = 0; i < ALBEDO_COSINES; i++) between[i] = rows[low][i] + (at - low) * (rows[low + 1][i] - rows[low][i]);
    return (1 - mean_of_row(between, NULL, r * r)) / r;
}

static void print_reflection(void) {
    double full[ALBEDO_ROUGHNESS][ALBEDO_COSINES], schlick[ALBEDO_ROUGHNESS][ALBEDO_COSINES];
    double schlick_mean[ALBEDO_ROUGHNESS];
    begin("const float albedo_full_table[ALBEDO_SLICE]");
    for (int j = 0; j < ALBEDO_ROUGHNESS; j++) {
        double a = albedo_row_alpha(j);
        for (int i = 0; i < ALBEDO_COSINES; i++) {
            put(full[j][i] = rounded(albedo(FULL, column_mu(i, a), a, 1)));
            schlick[j][i] = schlick_relative(column_mu(i, a), a);
        }
        schlick_mean[j] = mean_of_row(full[j], schlick[j], a);
    }
    end();
    begin("const float albedo_full_loss_table[ALBEDO_LOSSES]");
    for (int j = 0; j < ALBEDO_LOSSES; j++) put_loss(relative_loss(full, j));
    end();
    begin("const float albedo_schlick_table[ALBEDO_SLICE]");
    for (int j = 0; j < ALBEDO_ROUGHNESS; j++)
        for (int i = 0; i < ALBEDO_COSINES; i++) put(schlick[j][i]);
    end();
    begin("const float albedo_schlick_mean_table[ALBEDO_ROUGHNESS]");
    for (int j = 0; j < ALBEDO_ROUGHNESS; j++) put(schlick_mean[j]);
    end();
}

/* η of a slice of the interface table. */
static double slice_eta(int k) {
    double s = 2.0 * k / (ALBEDO_IORS - 1) - 1, x = (double)ALBEDO_X_MAX * s * fabs(s);
    return (1 + x) / (1 - x);
}

static void print_interface(void) {
    static double rows[ALBEDO_IORS][ALBEDO_ROUGHNESS][ALBEDO_COSINES];
    begin("const float albedo_interface_table[ALBEDO_SLICE * ALBEDO_IORS]");
    for (int k = 0; k < ALBEDO_IORS; k++)
        for (int j = 0; j < ALBEDO_ROUGHNESS; j++) {
            double a = albedo_row_alpha(j);
            for (int i = 0; i < ALBEDO_COSINES; i++)
                put(rows[k][j][i] = rounded(albedo(INTERFACE, column_mu(i, a), a, slice_eta(k))));
        }
    end();
    begin("const float albedo_interface_loss_table[ALBEDO_LOSSES * ALBEDO_IORS]");
    for (int k = 0; k < ALBEDO_IORS; k++)
        for (int j = 0; j < ALBEDO_LOSSES; j++) put_loss(relative_loss(rows[k], j));
    end();
}

/* lobes/sheen.h in double; l(x) and Λ of KHR_materials_sheen. */
static double sheen_l(double x, double alpha) {
    double t = (1 - alpha) * (1 - alpha), a = 21.5473 + (25.3245 - 21.5473) * t, b = 3.82987 + (3.32435 - 3.82987) * t;
    double c = 0.19823 + (0.16801 - 0.19823) * t, d = -1.97760 + (-1.27393 + 1.97760) * t;
    return a / (1 + b * pow(x, c)) + d * x - 4.32054 + (-4.85967 + 4.32054) * t;
}
static double sheen_big_lambda(double c, double alpha) {
    return exp(c < 0.5 ? sheen_l(c, alpha) : 2 * sheen_l(0.5, alpha) - sheen_l(1 - c, alpha));
}

/* Integrated over azimuths, and over elevations as sheen_sample spreads them. */
static double sheen_albedo(double mu, double roughness) {
    enum { ELEVATIONS = 512, AZIMUTHS = 64 };
    double alpha = roughness * roughness, s = (double)SHEEN_SPREAD * roughness, least = (double)SHEEN_COS_MIN;
    double so = sqrt(1 - mu * mu), co = fmax(mu, least), lo = sheen_big_lambda(co, alpha), sum = 0;
    for (int i = 0; i < ELEVATIONS; i++) {
        double u = (i + 0.5) / ELEVATIONS, z = s * u / (1 + s - u), r = sqrt(1 - z * z), ci = fmax(z, least), ring = 0;
        for (int j = 0; j < AZIMUTHS; j++) {
            double phi = M_PI * (j + 0.5) / AZIMUTHS, x = so + r * cos(phi), y = r * sin(phi), side = x * x + y * y;
            ring += pow(side / (side + (mu + z) * (mu + z)), 0.5 / alpha) / AZIMUTHS;
        }
        double visibility = 0.25 / ((1 + lo + sheen_big_lambda(ci, alpha)) * co * ci);
        sum += (2 + 1 / alpha) * ring * visibility * z * (s + z) * (s + z) / (s * (1 + s)) / ELEVATIONS;
    }
    return sum * fmin(roughness / (double)SHEEN_ROUGHNESS_FULL, 1);
}

static double sheen_row_roughness(int row) { return (row + 1.0) / ALBEDO_SHEEN_ROUGHNESS; }
static double sheen_mu(double t, double roughness) {
    double q = t * t * t * t, s = (double)SHEEN_SPREAD * roughness;
    return fmin(s * q / (1 + s - q), 1);
}

static void print_sheen(void) {
    double mean[ALBEDO_SHEEN_ROUGHNESS];
    begin("const float albedo_sheen_table[ALBEDO_SHEEN * ALBEDO_SHEEN_ROUGHNESS]");
    for (int j = 0; j < ALBEDO_SHEEN_ROUGHNESS; j++) {
        enum { N = 256 };
        double roughness = sheen_row_roughness(j), before = 0;
        for (int i = 0; i < ALBEDO_SHEEN; i++)
            put(sheen_albedo(sheen_mu((double)i / (ALBEDO_SHEEN - 1), roughness), roughness));
        mean[j] = 0;
        for (int i = 0; i < N; i++) { /* 2 ∫ E mu dmu */
            double mu = sheen_mu((i + 1.0) / N, roughness);
            mean[j] += sheen_albedo(sheen_mu((i + 0.5) / N, roughness), roughness) * (mu * mu - before * before);
            before = mu;
        }
    }
    end();
    begin("const float albedo_sheen_mean_table[ALBEDO_SHEEN_ROUGHNESS]");
    for (int j = 0; j < ALBEDO_SHEEN_ROUGHNESS; j++) put(mean[j]);
    end();
}

int main(void) {
    printf("/* Printed by tools/make_albedo_tables.c. */\n#include \"render/bsdf/albedo.h\"\n");
    print_reflection();
    print_interface();
    print_sheen();
    return 0;
}
