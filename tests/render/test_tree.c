/* The tree of lights: probabilities of a choice, against what is drawn, against the sum of 1, and against what each light
 * can do. Statistical tests have the level of one false alarm in a thousand for each test; seeds are fixed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include <math.h>

#include "render/light/light.h"
#include "render/light/tree.h"
#include "tests/render/statistics.h"

#define LEVEL 1e-3

typedef struct lights {
    kiln_arena arena;
    light *all;
    float *intensity;
    uint32_t count;
    light_tree *tree;
} lights;

typedef void place_light(stream *, uint32_t i, light *);

static void finish_triangle(light *l) {
    vec3 n = v3_cross(l->e1, l->e2);
    l->kind = LIGHT_TRIANGLE;
    l->area = 0.5f * v3_length(n);
    l->axis = l->area > 0 ? v3_scale(n, 0.5f / l->area) : v3(0, 0, 0);
}

static lights lights_make(uint32_t count, uint32_t seed, place_light *place) {
    lights s = {.all = calloc(count, sizeof *s.all), .intensity = calloc(count, sizeof *s.intensity), .count = count};
    stream random = {seed, 0};
    for (uint32_t i = 0; i < count; i++) {
        s.all[i].radiance = v3_splat(1);
        s.intensity[i] = 0.1f + stream_next(&random);
        place(&random, i, &s.all[i]);
        s.intensity[i] *= s.all[i].radiance.x * (s.all[i].kind == LIGHT_TRIANGLE ? s.all[i].area : 1);
    }
    s.tree = light_tree_build(&s.arena, s.all, s.intensity, count);
    assert_non_null(s.tree);
    return s;
}
static void lights_free(lights *s) {
    free(s->all);
    free(s->intensity);
    arena_free(&s->arena);
}

static vec3 point_in_box(stream *r) { return v3(stream_between(r, -1, 1), stream_between(r, -1, 1), stream_between(r, -1, 1)); }

static void a_triangle(stream *r, float size, light *l) {
    l->position = point_in_box(r);
    l->e1 = v3_scale(stream_direction(r), size * stream_next(r));
    l->e2 = v3_scale(stream_direction(r), size * stream_next(r));
    finish_triangle(l);
}
static void small_triangles(stream *r, uint32_t i, light *l) { (void)i, a_triangle(r, 0.05f, l); }
static void two_sided_triangles(stream *r, uint32_t i, light *l) { (void)i, a_triangle(r, 0.3f, l), l->two_sided = 1; }
static void points(stream *r, uint32_t i, light *l) { (void)i, l->kind = LIGHT_POINT, l->position = point_in_box(r); }
static void spots(stream *r, uint32_t i, light *l) {
    float outer = stream_between(r, 0.02f, 1.57f), inner = outer * stream_next(r);
    (void)i;
    l->kind = LIGHT_SPOT;
    l->position = point_in_box(r);
    l->axis = stream_direction(r);
    l->spot_scale = 1 / fmaxf(0.001f, cosf(inner) - cosf(outer));
    l->spot_offset = -cosf(outer) * l->spot_scale;
}
static void mixed(stream *r, uint32_t i, light *l) {
    (i % 4 == 0 ? points : i % 4 == 1 ? spots : i % 4 == 2 ? two_sided_triangles : small_triangles)(r, i, l);
}
/* A lamp: a fan of triangles that all face down. */
static void one_lamp(stream *r, uint32_t i, light *l) {
    (void)r;
    l->position = v3(0, 1, 0);
    l->e1 = v3(0.3f * cosf(0.1f * (float)i), 0, 0.3f * sinf(0.1f * (float)i));
    l->e2 = v3(0.3f * cosf(0.1f * (float)(i + 1)), 0, 0.3f * sinf(0.1f * (float)(i + 1)));
    finish_triangle(l);
    if (l->axis.y > 0) l->axis = v3_neg(l->axis);
}
static void in_one_place(stream *r, uint32_t i, light *l) { (void)r, (void)i, l->kind = LIGHT_POINT; }
/* Each half as far away as the one before: halves of bounds part one from the rest. */
static void halving(stream *r, uint32_t i, light *l) {
    (void)r;
    l->kind = LIGHT_POINT;
    l->position = v3(ldexpf(1, -(int)(i % 120)), ldexpf(1, -(int)(i / 120)), 0);
}
static void of_all_sizes(stream *r, uint32_t i, light *l) {
    a_triangle(r, 1, l);
    float size = powf(10, stream_between(r, -6, 0)), away = powf(10, stream_between(r, -3, 4));
    l->e1 = v3_scale(l->e1, size), l->e2 = v3_scale(l->e2, size), l->position = v3_scale(l->position, away);
    l->two_sided = (float)(i & 1);
    finish_triangle(l);
}

typedef struct row { const char *name; uint32_t count; place_light *place; } row;
static const row rows[] = {{"one", 1, small_triangles}, {"eight points", 8, points}, {"nine points", 9, points},
                           {"triangles", 300, small_triangles}, {"two-sided", 300, two_sided_triangles},
                           {"spots", 300, spots}, {"mixed", 1000, mixed}, {"a lamp", 62, one_lamp},
                           {"in one place", 100, in_one_place}, {"halving", 2000, halving},
                           {"of all sizes", 1000, of_all_sizes}};
enum { ROWS = sizeof rows / sizeof *rows };

/* Somewhere: in the scene, on a light, next to one, far away; with a normal or without. */
static vantage somewhere(stream *r, const lights *s) {
    const light *l = &s->all[(uint32_t)(stream_next(r) * (float)s->count)];
    int where = (int)(stream_next(r) * 5);
    vec3 near = v3_madd(l->position, powf(10, stream_between(r, -6, 0)), stream_direction(r));
    vec3 p = where == 0 ? l->position : where == 1 ? near : where == 2 ? v3_scale(stream_direction(r), 50) : point_in_box(r);
    bool faces = stream_next(r) < 0.7f;
    return (vantage){p, faces ? stream_direction(r) : v3_splat(0), 0};
}

static tree_start choose(const lights *s, const vantage *v, float far, stream *r) {
    float u = stream_next(r);
    tree_start start = tree_enter(s->tree, v, far, u, stream_next(r));
    while (!start.is_far && !(start.step.child & TREE_LEAF)) tree_go_down(s->tree, v, &start.step);
    return start;
}

/* Choices that end nowhere, because bounds are loose, are what is missing from 1: there are as many as that. */
static void probabilities_sum_to_one(void **state) {
    (void)state;
    enum { PLACES = 60, DRAWS = 400 };
    for (int k = 0; k < ROWS; k++) {
        lights s = lights_make(rows[k].count, 31 + (uint32_t)k, rows[k].place);
        stream random = {32, 0};
        double missing = 0, lost = 0, variance = 0;
        for (int i = 0; i < PLACES; i++) {
            vantage v = somewhere(&random, &s);
            double sum = 0;
            for (uint32_t j = 0; j < s.count; j++) {
                float p = tree_probability(s.tree, j, &v);
                if (!(p >= 0 && p <= 1)) fail_msg("%s: a probability of %g", rows[k].name, (double)p);
                sum += (double)p;
            }
            if (sum > 1 + 1e-5) fail_msg("%s: probabilities sum to %.9g", rows[k].name, sum);
            for (int n = 0; n < DRAWS; n++) lost += !(choose(&s, &v, 0, &random).step.p > 0);
            missing += DRAWS * (1 - sum);
            variance += DRAWS * fmax(sum * (1 - sum), 0);
        }
        if (fabs(lost - missing) > 3.9 * sqrt(variance) + 0.01 * PLACES)
            fail_msg("%s: %g choices end nowhere, probabilities say %g", rows[k].name, lost, missing);
        lights_free(&s);
    }
}

/* What is drawn comes with the very bits that are computed for it, and as often as they say. */
static void choices_follow_probabilities(void **state) {
    (void)state;
    enum { PLACES = 5, DRAWS = 20000 };
    for (int k = 0; k < ROWS; k++) {
        lights s = lights_make(rows[k].count, 41 + (uint32_t)k, rows[k].place);
        double *counts = calloc(s.count + 1, sizeof *counts), *expected = calloc(s.count + 1, sizeof *expected);
        stream random = {42, 0};
        for (int i = 0; i < PLACES; i++) {
            vantage v = somewhere(&random, &s);
            double sum = 0;
            for (uint32_t j = 0; j <= s.count; j++) {
                counts[j] = 0;
                expected[j] = j < s.count ? DRAWS * (double)tree_probability(s.tree, j, &v) : DRAWS - sum;
                sum += expected[j];
            }
            for (int n = 0; n < DRAWS; n++) {
                tree_step drawn = choose(&s, &v, 0, &random).step;
                uint32_t which = drawn.child & TREE_INDEX;
                assert_true(drawn.u >= 0 && drawn.u < 1);
                counts[drawn.p > 0 ? which : s.count]++;
                if (drawn.p > 0 && drawn.p != tree_probability(s.tree, which, &v))
                    fail_msg("%s: light %u is drawn with %.9g, computed %.9g", rows[k].name, which, (double)drawn.p,
                             (double)tree_probability(s.tree, which, &v));
            }
            expected[s.count] = fmax(expected[s.count], 0);
            if (chi_square_p(counts, expected, s.count + 1) < sidak(LEVEL, ROWS * PLACES))
                fail_msg("%s: choices do not follow their probabilities", rows[k].name);
        }
        free(counts);
        free(expected);
        lights_free(&s);
    }
}

/* Does this light shine on the point from any of a few places on it? */
static bool may_light(const light *l, const vantage *v, stream *r) {
    for (int i = 0; i < 4; i++) {
        light_sampled d = light_sample(KIND(LIGHT_TRIANGLE) | KIND(LIGHT_POINT) | KIND(LIGHT_SPOT), l, v->p, stream_pair(r));
        bool arrives = v3_dot(v->up, v->up) > 0 ? v3_dot(v->up, d.wi) > 0 : true;
        if (d.pdf > 0 && d.radiance.x > 0 && arrives) return true;
    }
    return false;
}

static void what_can_light_a_point_can_be_chosen(void **state) {
    (void)state;
    enum { PLACES = 150 };
    uint64_t lit = 0, dark = 0;
    for (int k = 0; k < ROWS; k++) {
        lights s = lights_make(rows[k].count, 51 + (uint32_t)k, rows[k].place);
        stream random = {52, 0};
        for (int i = 0; i < PLACES; i++) {
            vantage v = somewhere(&random, &s);
            for (uint32_t j = 0; j < s.count; j++) {
                float p = tree_probability(s.tree, j, &v);
                bool may = may_light(&s.all[j], &v, &random);
                if (may && s.intensity[j] > 0 && !(p > 0))
                    fail_msg("%s: light %u of %u is never chosen where it shines", rows[k].name, j, s.count);
                lit += may, dark += !may && p == 0;
            }
        }
        lights_free(&s);
    }
    assert_true(lit > 100000 && dark > 100000); /* bounds that say nothing would pass */
}

/* Each half as far away as the one before, over all exponents of floats: splits by cost would take 23 levels. */
static void halving_all_the_way(stream *r, uint32_t i, light *l) {
    (void)r;
    l->kind = LIGHT_POINT;
    l->position = v3(ldexpf(1, 120 - (int)(i % 250)), (float)(i / 250) * 1e-3f, 0);
}

static void trails_lead_to_their_lights(void **state) {
    (void)state;
    lights s = lights_make(24000, 81, halving_all_the_way);
    for (uint32_t i = 0; i < s.count; i++) {
        uint64_t trail = s.tree->trails[i];
        uint32_t child = 0;
        for (int level = 0; level < TREE_LEVELS && !(child & TREE_LEAF); level++, trail >>= TREE_SLOT_BITS)
            child = s.tree->nodes[child & TREE_INDEX].child[trail & (TREE_WIDTH - 1)];
        assert_true(child & TREE_LEAF && (child & TREE_INDEX) == i && trail == 0);
    }
    lights_free(&s);
}

/* A light beside the point is chosen more often than one far away, one that faces it more often than one that does not. */
static void near_and_facing_lights_come_first(void **state) {
    (void)state;
    lights s = {.all = calloc(64, sizeof *s.all), .intensity = calloc(64, sizeof *s.intensity), .count = 64};
    for (uint32_t i = 0; i < 64; i++) {
        light *l = &s.all[i];
        l->position = v3((float)(i / 2), 1, 0), l->e1 = v3(0.1f, 0, 0), l->e2 = v3(0, 0, i & 1 ? 0.1f : -0.1f);
        finish_triangle(l);
        s.intensity[i] = l->area;
    }
    s.tree = light_tree_build(&s.arena, s.all, s.intensity, s.count);
    vantage v = {v3(3, 0, 0), v3(0, 1, 0), 0};
    uint32_t down = s.all[6].axis.y < 0 ? 0u : 1u;
    float near = tree_probability(s.tree, 6 + down, &v), far = tree_probability(s.tree, 60 + down, &v);
    assert_true(near > 0.3f && near > 100 * far && far > 0);
    assert_true(tree_probability(s.tree, 7 - down, &v) < 0.01f * near); /* its back */
    lights_free(&s);
}

/* Lights without a place take their share, but neither side starves the other; whoever is alone takes all. */
static void the_far_have_their_share(void **state) {
    (void)state;
    assert_true(tree_far_share(1, 0) == 0 && tree_far_share(0, 1) == 1 && tree_far_share(0, 0) == 0);
    assert_float_equal(tree_far_share(1, 1), 0.5, 1e-6);
    for (int k = -120; k <= 120; k += 10) {
        float share = tree_far_share(1, ldexpf(1, k));
        assert_true(share >= 0.25f && share <= 0.75f);
    }
    lights s = lights_make(50, 61, points);
    stream random = {62, 0};
    vantage v = somewhere(&random, &s);
    float share = choose(&s, &v, 2, &random).far_share;
    int far = 0;
    enum { DRAWS = 20000 };
    for (int i = 0; i < DRAWS; i++) far += choose(&s, &v, 2, &random).is_far;
    double deviation = (far - DRAWS * (double)share) / sqrt(DRAWS * (double)share * (1 - (double)share));
    assert_true(normal_tail(deviation) > LEVEL);
    lights_free(&s);
}

/* Random numbers at their ends, and lights that are black or of any brightness. */
static void extremes_are_survived(void **state) {
    (void)state;
    lights s = lights_make(200, 71, mixed);
    for (uint32_t i = 0; i < s.count; i++) s.intensity[i] = i % 5 == 0 ? 0 : ldexpf(1, (int)(i % 200) - 100);
    s.tree = light_tree_build(&s.arena, s.all, s.intensity, s.count);
    stream random = {72, 0};
    for (int i = 0; i < 500; i++) {
        vantage v = somewhere(&random, &s);
        v.p = v3_scale(v.p, ldexpf(1, i % 60 - 30));
        for (int end = 0; end < 2; end++) {
            float last = end ? 0x1.fffffep-1f : 0;
            tree_start start = tree_enter(s.tree, &v, (float)(i % 3), last, last);
            for (int level = 0; !start.is_far && !(start.step.child & TREE_LEAF); level++) {
                assert_true(level < TREE_LEVELS);
                tree_go_down(s.tree, &v, &start.step);
            }
            float fine, rest = tree_rest(start.step.u, &fine);
            assert_true(rest >= 0 && rest < 1 && fine >= 0 && fine < 1);
            if (!start.is_far) assert_true(start.step.p >= 0 && start.step.p <= 1 && (start.step.child & TREE_INDEX) < s.count);
        }
        for (uint32_t j = 0; j < s.count; j += 5) assert_true(tree_probability(s.tree, j, &v) == 0);
    }
    lights_free(&s);
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(probabilities_sum_to_one),  cmocka_unit_test(choices_follow_probabilities),
        cmocka_unit_test(what_can_light_a_point_can_be_chosen), cmocka_unit_test(near_and_facing_lights_come_first),
        cmocka_unit_test(the_far_have_their_share),  cmocka_unit_test(extremes_are_survived),
        cmocka_unit_test(trails_lead_to_their_lights),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]); /* of mutants: the case that must see them */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
