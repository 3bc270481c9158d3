/* Camera rays against the closed forms of the pinhole, the parallel projection and the thin lens, and how a lens shows
 * in pictures. Seeds are fixed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/film/film.h"
#include "render/path/camera.h"
#include "tests/render/scenes.h"
#include "tests/render/statistics.h"

static dvec3 to_double(vec3 v) { return (dvec3){(double)v.x, (double)v.y, (double)v.z}; }

/* A world whose render space is neither centred nor scaled as the scene is. */
static world *far_world(scene_builder *b) {
    *b = builder_make();
    add_box(b, 0, (float[]){90, -30, 10}, (float[]){130, 10, 40});
    return build_world(b);
}

static camera make(const world *w, const kiln_camera *from, uint32_t width, uint32_t height) {
    camera c;
    kiln_report *report = kiln_report_create();
    must(camera_make(w, from, width, height, &c, report), report, "making a camera");
    kiln_report_destroy(report);
    return c;
}

/* The frame and the distances that a kiln_camera stands for, in render space. */
typedef struct model { dvec3 eye, right, up, back; double half_height, half_width, focus, lens; } model;

static model model_of(const world *w, const kiln_camera *c, double aspect) {
    model m = {.eye = world_point(w, d3_load(c->transform + 12)),
               .right = d3_normalize(d3_load(c->transform)),
               .up = d3_normalize(d3_load(c->transform + 4)),
               .back = d3_normalize(d3_load(c->transform + 8)),
               .focus = c->focus_distance * w->scale,
               .lens = c->lens_radius * w->scale};
    m.half_height = c->projection == KILN_ORTHOGRAPHIC ? c->ymag * w->scale : tan(c->yfov_rad / 2);
    m.half_width = m.half_height * aspect;
    return m;
}
static dvec3 place(const model *m, double x, double y, double depth) {
    return d3_add(m->eye, d3_add(d3_scale(m->right, x), d3_sub(d3_scale(m->up, y), d3_scale(m->back, depth))));
}
/* Where a ray crosses the plane at a depth, as x and y in the camera's frame. */
static void cross(const model *m, const camera_ray *r, double depth, double *x, double *y) {
    dvec3 o = d3_sub(to_double(r->origin), m->eye), d = to_double(r->direction);
    double t = (depth + d3_dot(o, m->back)) / -d3_dot(d, m->back);
    dvec3 p = d3_add(o, d3_scale(d, t));
    *x = d3_dot(p, m->right), *y = d3_dot(p, m->up);
}

static kiln_camera tilted(void) {
    kiln_camera c = camera_at((float[]){80, 20, 55}, (float[]){110, -5, 20}, 50);
    c.znear = 2, c.zfar = 300;
    return c;
}

/* Pixel (x, y) of [−1, 1]²: from the eye through (x tan(fov/2) aspect, y tan(fov/2), −1); near and far are depths. */
static void pinholes_project(void **state) {
    (void)state;
    scene_builder b;
    world *w = far_world(&b);
    kiln_camera from = tilted();
    static const uint32_t sizes[][2] = {{100, 100}, {160, 90}, {90, 160}, {1, 65536}};
    for (int i = 0; i < 4; i++) {
        camera c = make(w, &from, sizes[i][0], sizes[i][1]);
        model m = model_of(w, &from, (double)sizes[i][0] / sizes[i][1]);
        stream s = {31, 0};
        for (int k = 0; k < 1000; k++) {
            float x = stream_between(&s, -1, 1), y = stream_between(&s, -1, 1);
            camera_ray r = camera_ray_at(&c, x, y, stream_pair(&s));
            dvec3 to = place(&m, (double)x * m.half_width, (double)y * m.half_height, 1);
            dvec3 d = d3_normalize(d3_sub(to, m.eye));
            assert_true(d3_length(d3_sub(to_double(r.direction), d)) < 1e-6);
            assert_true(d3_length(d3_sub(to_double(r.origin), m.eye)) < 1e-6);
            double along = -d3_dot(d, m.back);
            assert_true(fabs((double)r.near * along / w->scale - 2) < 1e-5 * 2);
            assert_true(fabs((double)r.far * along / w->scale - 300) < 1e-5 * 300);
        }
    }
    world_destroy(w);
    builder_free(&b);
}

/* Parallel rays along −back through the plane of the eye; ymag is half the height. */
static void parallel_projections_project(void **state) {
    (void)state;
    scene_builder b;
    world *w = far_world(&b);
    kiln_camera from = tilted();
    from.projection = KILN_ORTHOGRAPHIC, from.xmag = 7, from.ymag = 5;
    camera c = make(w, &from, 160, 90);
    model m = model_of(w, &from, 160.0 / 90);
    stream s = {32, 0};
    for (int k = 0; k < 1000; k++) {
        float x = stream_between(&s, -1, 1), y = stream_between(&s, -1, 1);
        camera_ray r = camera_ray_at(&c, x, y, stream_pair(&s));
        dvec3 o = place(&m, (double)x * m.half_width, (double)y * m.half_height, 0);
        assert_true(d3_length(d3_add(to_double(r.direction), m.back)) < 1e-6);
        assert_true(d3_length(d3_sub(to_double(r.origin), o)) < 1e-6);
        assert_true(fabs((double)r.near / w->scale - 2) < 2e-5);
    }
    world_destroy(w);
    builder_free(&b);
}

/* Scale, and a right that leans: the axes are those of the view, −Z and what is left of +Y across it. */
static void cameras_have_no_scale(void **state) {
    (void)state;
    scene_builder b;
    world *w = far_world(&b);
    kiln_camera plain = tilted(), scaled = plain;
    for (int i = 0; i < 3; i++) {
        scaled.transform[i] = 5 * plain.transform[i] + 0.2 * plain.transform[8 + i];
        scaled.transform[4 + i] = 0.1 * plain.transform[4 + i] + 0.03 * plain.transform[8 + i];
        scaled.transform[8 + i] = 3 * plain.transform[8 + i];
    }
    camera a = make(w, &plain, 160, 90), c = make(w, &scaled, 160, 90);
    for (int k = 0; k < 9; k++) {
        camera_ray p = camera_ray_at(&a, (float)(k % 3) - 1, (float)k / 3 - 1, (vec2){0, 0});
        camera_ray q = camera_ray_at(&c, (float)(k % 3) - 1, (float)k / 3 - 1, (vec2){0, 0});
        assert_true(v3_length(v3_sub(p.direction, q.direction)) < 1e-6f && fabsf(p.near - q.near) < 1e-6f);
    }
    world_destroy(w);
    builder_free(&b);
}

/* All rays of a pixel meet at its point in the plane of focus; elsewhere they fill the circle of confusion, of radius
 * R |1 − d/f| in the plane at depth d, or for a polygon its likeness. */
static void lenses_focus(void **state) {
    (void)state;
    scene_builder b;
    world *w = far_world(&b);
    static const double depths[] = {0, 0.5, 0.9, 1.1, 2, 10};
    for (int row = 0; row < 4; row++) {
        kiln_camera from = tilted();
        from.projection = row & 1 ? KILN_ORTHOGRAPHIC : KILN_PERSPECTIVE;
        from.xmag = from.ymag = 6, from.lens_radius = 1.7, from.focus_distance = 23, from.blades = row & 2 ? 6 : 0;
        camera c = make(w, &from, 160, 90);
        model m = model_of(w, &from, 160.0 / 90);
        stream s = {33, 0};
        double largest[6] = {0};
        for (int k = 0; k < 5000; k++) {
            float px = stream_between(&s, -1, 1), py = stream_between(&s, -1, 1);
            camera_ray r = camera_ray_at(&c, px, py, stream_pair(&s));
            double grows = row & 1 ? 1 : m.focus, x, y;
            double fx = (double)px * m.half_width * grows, fy = (double)py * m.half_height * grows;
            cross(&m, &r, m.focus, &x, &y);
            assert_true(hypot(x - fx, y - fy) < 1e-6 && fabs((double)v3_length(r.direction) - 1) < 1e-6);
            for (int i = 0; i < 6; i++) { /* the ray through the lens's middle */
                double cx = row & 1 ? fx : fx * depths[i], cy = row & 1 ? fy : fy * depths[i];
                cross(&m, &r, depths[i] * m.focus, &x, &y);
                largest[i] = fmax(largest[i], hypot(x - cx, y - cy));
            }
        }
        for (int i = 0; i < 6; i++) {
            double radius = m.lens * fabs(1 - depths[i]);
            assert_true(largest[i] < radius + 2e-6 && largest[i] > 0.98 * radius);
        }
    }
    world_destroy(w);
    builder_free(&b);
}

/* Points of the aperture are uniform: moments against those of the disk and of the regular polygon of circumradius 1
 * (E r² = (2 + cos(2π/n))/6), within 4 standard errors; polygons have a vertex at their rotation. */
static void apertures_are_uniform(void **state) {
    (void)state;
    enum { POINTS = 200000 };
    static const uint32_t blades[] = {0, 3, 5, 6, 16};
    for (int row = 0; row < 5; row++) {
        uint32_t n = blades[row];
        const double turn = 0.7, tau = 2 * M_PI;
        camera c = {.blades = (float)n, .blade_rotation_turns = (float)(turn / tau), .lens_radius = 1, .focus = 1};
        tally x = {0}, y = {0}, square = {0};
        stream s = {34, 0};
        double apothem = n ? cos(M_PI / n) : 1;
        for (int k = 0; k < POINTS; k++) {
            vec2 p = camera_lens(&c, stream_pair(&s));
            double r = hypot((double)p.x, (double)p.y), inside = r;
            for (uint32_t i = 0; i < n; i++) { /* distance along the middle of each side */
                double a = turn + tau * (i + 0.5) / n, d = ((double)p.x * cos(a) + (double)p.y * sin(a)) / apothem;
                inside = i ? fmax(inside, d) : d;
            }
            assert_true(inside < 1 + 1e-6);
            tally_add(&x, (double)p.x), tally_add(&y, (double)p.y), tally_add(&square, r * r);
        }
        double moment = n ? (2 + cos(tau / n)) / 6 : 0.5;
        assert_true(fabs(x.mean) < 4 * tally_error(&x) && fabs(y.mean) < 4 * tally_error(&y));
        assert_true(fabs(square.mean - moment) < 4 * tally_error(&square));
    }
}

/* Without a distance the lens focuses on what the middle of the picture sees. */
static void lenses_find_their_focus(void **state) {
    (void)state;
    scene_builder b;
    world *w = far_world(&b);
    kiln_camera from = camera_at((float[]){110, -10, 100}, (float[]){110, -10, 0}, 30);
    from.lens_radius = 0.1;
    camera c = make(w, &from, 100, 100); /* the box's side at z = 40 */
    assert_true(fabs((double)c.focus / w->scale - 60) < 1e-4);
    from.znear = 70; /* its far side at z = 10 */
    assert_true(fabs((double)make(w, &from, 100, 100).focus / w->scale - 90) < 1e-4);
    from.znear = 0;
    from.transform[13] = 500; /* nothing */
    c = make(w, &from, 100, 100);
    assert_true(c.focus > 0 && c.focus < INFINITY);
    world_destroy(w);
    builder_free(&b);
}

/* A lamp of 2 × 2 pixels at a depth, seen by a lens that is focused on another. */
enum { SIDE = 64 };
static picture lamp_picture(double depth, double focus, double lens) {
    const double yfov = 20 * M_PI / 180, pixel = 2 * tan(yfov / 2) * depth / SIDE;
    scene_builder b = builder_make();
    kiln_material m = diffuse_material(1, 1, 1);
    m.layers = KILN_LAYER_UNLIT;
    float a = (float)pixel, z = (float)-depth;
    add_quad(&b, add_material(&b, &m), (float[]){-a, -a, z, a, -a, z, a, a, z, -a, a, z});
    kiln_camera view = kiln_camera_default();
    view.yfov_rad = yfov, view.focus_distance = focus, view.lens_radius = lens;
    kiln_render_options o = {.spp = 512, .max_depth = 1, .filter = KILN_PIXEL_BOX};
    picture p = render(&b, &view, &o, SIDE, SIDE);
    builder_free(&b);
    return p;
}

/* In focus the lamp is its four pixels, whatever the lens; and so it is for a pinhole. */
static void what_is_in_focus_is_sharp(void **state) {
    (void)state;
    static const double lenses[][2] = {{5, 0.3}, {5, 0}, {2, 0}};
    for (int i = 0; i < 3; i++) {
        picture p = lamp_picture(5, lenses[i][0], lenses[i][1]);
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                bool lamp = abs(2 * x + 1 - SIDE) == 1 && abs(2 * y + 1 - SIDE) == 1;
                double edge = abs(2 * x + 1 - SIDE) <= 3 && abs(2 * y + 1 - SIDE) <= 3 ? 0.01 : 0; /* rounding */
                assert_true(fabs((double)p.rgb[3 * (y * SIDE + x)] - lamp) <= edge);
            }
        picture_free(&p);
    }
}

/* Out of focus it is a disk of radius R |1/f − 1/d| H/(2 tan(fov/2)) pixels: as much light in all, none outside, a
 * variance of r²/4 and that of the lamp (2² / 12) and of the pixels it is counted in (1/12) in each direction; within
 * 4 standard errors, as the replicates show them. */
static void what_is_out_of_focus_blurs(void **state) {
    (void)state;
    static const struct { double depth, focus, lens; } rows[] = {
        {5, 3, 0.1}, {5, 12, 0.1}, {5, 2.4, 0.05}, {5, 100, 0.05}};
    for (int i = 0; i < 4; i++) {
        double radius = rows[i].lens * fabs(1 / rows[i].focus - 1 / rows[i].depth) * SIDE / (2 * tan(10 * M_PI / 180));
        assert_true(radius > 1.2 && radius < 20);
        picture p = lamp_picture(rows[i].depth, rows[i].focus, rows[i].lens);
        const double variance = radius * radius / 4 + 5.0 / 12;
        double sum = 0, off[3] = {0}, sum_error = 0, error[3] = {0}, mean[3], squared[3];
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                double v = (double)p.rgb[3 * (y * SIDE + x)], dx = x + 0.5 - SIDE / 2, dy = y + 0.5 - SIDE / 2;
                const double parts[3] = {dx * dx - variance, dy * dy - variance, dx * dy};
                film_read_pixel(p.film, (size_t)(y * SIDE + x), mean, squared);
                sum += v, sum_error += squared[0];
                for (int k = 0; k < 3; k++) off[k] += v * parts[k], error[k] += squared[0] * parts[k] * parts[k];
                if (v > 0 && hypot(dx, dy) > radius + 1.5 * M_SQRT2 + 1e-3)
                    fail_msg("light at %g, %g pixels from a blur of radius %g", dx, dy, radius);
            }
        if (fabs(sum - 4) > 4 * sqrt(sum_error) || sqrt(sum_error) > 0.15) fail_msg("radius %g: sum %g", radius, sum);
        for (int k = 0; k < 3; k++)
            if (fabs(off[k]) > 4 * sqrt(error[k]) || sqrt(error[k]) > 0.05 * sum * variance)
                fail_msg("radius %g: moment %d of %g is %g ± %g off", radius, k, variance, off[k] / sum,
                         sqrt(error[k]) / sum);
        picture_free(&p);
    }
}

/* A picture of one colour a pixel comes out as itself: where rows begin, which way y runs, where pixels have their
 * middle, what a crop is. */
static void pixels_see_their_place(void **state) {
    (void)state;
    enum { W = 24, H = 16 };
    float rgb[W * H * 3];
    for (uint32_t i = 0; i < W * H * 3; i++) rgb[i] = unit_float(hash_pair(35, i));
    scene_builder b = builder_make();
    kiln_material m = diffuse_material(1, 1, 1);
    m.layers = KILN_LAYER_UNLIT;
    m.base_color.texture = (kiln_texture){.image = add_image(&b, rgb, W, H), .filter = KILN_FILTER_NEAREST};
    add_quad(&b, add_material(&b, &m), (float[]){-1.5f, -1, 0, 1.5f, -1, 0, 1.5f, 1, 0, -1.5f, 1, 0});
    must(kiln_scene_commit(b.scene, b.report), b.report, "committing");
    kiln_renderer *renderer;
    must(kiln_renderer_create(b.scene, NULL, &renderer, b.report), b.report, "making a renderer");
    kiln_camera view = camera_at((float[]){0, 0, 5}, (float[]){0, 0, 0}, 0);
    view.projection = KILN_ORTHOGRAPHIC, view.yfov_rad = 1, view.xmag = view.ymag = 1;
    for (int i = 0; i < 2; i++) {
        kiln_film_desc desc = {.width = W, .height = H, .crop = {i ? 5 : 0, i ? 3 : 0, i ? 20 : W, i ? 13 : H}};
        kiln_render_options o = {.camera = &view, .spp = 16, .filter = KILN_PIXEL_BOX, .filter_width = 0.99};
        picture p = render_with(renderer, &o, &desc, b.report);
        for (uint32_t y = 0; y < p.height; y++)
            for (uint32_t x = 0; x < 3 * p.width; x++) {
                float expected = rgb[3 * W * (y + desc.crop[1]) + 3 * desc.crop[0] + x];
                assert_float_equal(p.rgb[3 * p.width * y + x], expected, 1e-6f);
            }
        picture_free(&p);
    }
    kiln_renderer_destroy(renderer);
    builder_free(&b);
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pinholes_project),        cmocka_unit_test(parallel_projections_project),
        cmocka_unit_test(cameras_have_no_scale),   cmocka_unit_test(lenses_focus),
        cmocka_unit_test(apertures_are_uniform),   cmocka_unit_test(lenses_find_their_focus),
        cmocka_unit_test(what_is_in_focus_is_sharp), cmocka_unit_test(what_is_out_of_focus_blurs),
        cmocka_unit_test(pixels_see_their_place),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]); /* of mutants: the case that must see them */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
