#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/job/support.h"
#include "kiln/job.h"

/* Where a point lies in the picture: −1 … 1 either way; depth along the axis. */
static void project(const kiln_camera *c, double aspect, dvec3 p, double xy[2], double *depth) {
    const double *m = c->transform;
    dvec3 d = d3_sub(p, d3_load(m + 12));
    *depth = -d3_dot(d, d3_load(m + 8));
    xy[1] = d3_dot(d, d3_load(m + 4)) / *depth / tan(c->yfov_rad / 2);
    xy[0] = d3_dot(d, d3_load(m)) / *depth / tan(c->yfov_rad / 2) / aspect;
}

typedef struct extent { double low[2], high[2]; } extent;

/* The picture that the scene's points fill; all must lie before the eye. */
static extent project_scene(const fixture *f, const kiln_camera *c, double aspect) {
    extent e = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < f->scene->instance_count; i++) {
        const kiln_mesh *m = scene_mesh(f->scene, f->scene->instances[i].mesh);
        for (uint32_t v = 0; v < m->vertex_count; v++) {
            const float *p = m->positions + 3 * v;
            double xy[2], depth;
            project(c, aspect, mat4_point(f->scene->instances[i].transforms, (dvec3){p[0], p[1], p[2]}), xy, &depth);
            assert_true(depth > 0);
            for (int k = 0; k < 2; k++) e.low[k] = fmin(e.low[k], xy[k]), e.high[k] = fmax(e.high[k], xy[k]);
        }
    }
    return e;
}

/* Everything is inside the margin, touches it on one axis, and is in the middle on both. */
static void assert_framed(const fixture *f, const kiln_framing *framing, double tolerance) {
    double aspect = framing->aspect > 0 ? framing->aspect : 1, fit = framing->fit > 0 ? framing->fit : 0.85;
    kiln_camera c = kiln_camera_frame(f->scene, framing);
    extent e = project_scene(f, &c, aspect);
    double widest = 0;
    for (int k = 0; k < 2; k++) {
        assert_true(e.low[k] >= -fit - tolerance && e.high[k] <= fit + tolerance);
        widest = fmax(widest, e.high[k]);
        if (e.high[k] > fit - tolerance || e.low[k] < -fit + tolerance)
            assert_near(e.high[k], -e.low[k], 4 * tolerance);
    }
    assert_near(widest, fit, tolerance);
}

static void from_all_sides(const fixture *f, double tolerance) {
    static const double aspects[] = {0, 16.0 / 9, 0.4}, fits[] = {0, 0.5, 1, 1.5}, fovs[] = {0, 0.1, 2};
    for (int az = -180; az < 180; az += 50)
        for (int el = -90; el <= 90; el += 30)
            for (int i = 0; i < 3; i++) {
                kiln_framing framing = {az * M_PI / 180, el * M_PI / 180, fovs[i], aspects[i],
                                        fits[(i + az + 200) % 4]};
                assert_framed(f, &framing, tolerance);
            }
}

static void a_box_fills_its_share_from_all_sides(void **state) {
    fixture *f = *state;
    add_box(f, (float[]){-1, -2, -0.5f}, (float[]){1, 1, 3}, 0);
    from_all_sides(f, 1e-9);
}

/* Far away from the origin, 64-bit coordinates have 10⁻¹⁶ of the distance left for the framing. */
static void distant_small_and_large_scenes(void **state) {
    fixture *f = *state;
    add_box(f, (float[]){1e6f, 0, 0}, (float[]){1e6f + 4, 3, 2}, 0);
    from_all_sides(f, 1e-7);
    fixture_close(state);
    fixture_open(state);
    add_box(*state, (float[]){0, 0, 0}, (float[]){1e-6f, 2e-6f, 1e-6f}, 0);
    from_all_sides(*state, 1e-9);
    fixture_close(state);
    fixture_open(state);
    add_box(*state, (float[]){-1e7f, 0, 0}, (float[]){1e7f, 2e7f, 1e6f}, 0);
    from_all_sides(*state, 1e-9);
}

static void flat_things_are_framed_too(void **state) {
    fixture *f = *state;
    add_box(f, (float[]){-1, 0, -1}, (float[]){1, 0, 1}, 0);
    assert_framed(f, &(kiln_framing){.azimuth_rad = 0.5, .elevation_rad = 0.3}, 1e-9);
    assert_framed(f, &(kiln_framing){.elevation_rad = 0}, 1e-9); /* edge on */
    assert_framed(f, &(kiln_framing){.elevation_rad = M_PI / 2}, 1e-9);
}

static void assert_sees(const fixture *f, const kiln_framing *framing, dvec3 p) {
    kiln_camera c = kiln_camera_frame(f->scene, framing);
    double xy[2], depth;
    project(&c, 1, p, xy, &depth);
    assert_true(depth > 1e-3 && fabs(xy[0]) < 1e-6 && fabs(xy[1]) < 1e-6);
}

static void points_lines_and_nothing_leave_a_distance(void **state) {
    fixture *f = *state;
    const kiln_framing side = {.azimuth_rad = 0.7, .elevation_rad = 0.4}, front = {0};
    assert_sees(f, &side, (dvec3){0, 0, 0});
    add_box(f, (float[]){5, 6, 7}, (float[]){5, 6, 7}, 0);
    assert_sees(f, &side, (dvec3){5, 6, 7});
    fixture_close(state);
    fixture_open(state);
    add_box(*state, (float[]){0, 0, -4}, (float[]){0, 0, 4}, 0); /* a line towards the eye */
    assert_sees(*state, &front, (dvec3){0, 0, 4});
    assert_sees(*state, &front, (dvec3){0, 0, -4});
}

/* Instances inside others' boxes cannot move the frame; those that stick out do, in whatever order they come. */
static void all_instances_count(void **state) {
    fixture *f = *state;
    kiln_id mesh;
    add_box(f, (float[]){-1, -1, -1}, (float[]){1, 1, 1}, 0);
    mesh = f->scene->instances[0].mesh;
    for (int i = 0; i < 20; i++) {
        const double q[4] = {0, sin(i * 0.3), 0, cos(i * 0.3)}, t[3] = {7 * sin(i), i - 10, 3 * cos(2 * i)},
                     s[3] = {1, 0.2 * i, 1};
        mat4 m = mat4_trs(t, q, s);
        assert_done(f, kiln_scene_add_instance(f->scene,
                                               &(kiln_instance_desc){.mesh = mesh, .time_count = 1, .transforms = m.m},
                                               NULL, f->report));
    }
    from_all_sides(f, 1e-9);
}

int main(void) {
    const struct CMUnitTest tests[] = {JOB_TEST(a_box_fills_its_share_from_all_sides),
                                       JOB_TEST(distant_small_and_large_scenes), JOB_TEST(flat_things_are_framed_too),
                                       JOB_TEST(points_lines_and_nothing_leave_a_distance),
                                       JOB_TEST(all_instances_count)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
