/* What is inside of solids: how media rank, what they take away, and whether any may touch. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "render/path/camera.h"
#include "render/world/world.h"
#include "tests/render/scenes.h"

static kiln_material solid(int32_t priority) {
    kiln_material m = kiln_material_default();
    m.layers = KILN_LAYER_TRANSMISSION | KILN_LAYER_VOLUME;
    m.metallic.value = 0, m.transmission.value = 1, m.thickness.value = 1;
    m.priority = priority;
    return m;
}

/* A cube about a point of the x axis. */
static kiln_id add_cube(scene_builder *b, const kiln_material *m, float x, float half) {
    kiln_id id = add_material(b, m);
    add_box(b, id, (float[]){x - half, -half, -half}, (float[]){x + half, half, half});
    return id;
}

static kiln_id add_solid(scene_builder *b, int32_t priority, float x, float half) {
    kiln_material m = solid(priority);
    return add_cube(b, &m, x, half);
}

/* By priority, then the smaller one, whatever their order; a copy counts by its own size. */
static void media_rank(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_id small = add_solid(&b, 0, 0, 1), large = add_solid(&b, 0, 0, 2), first = add_solid(&b, 1, 0, 3);
    kiln_id last = add_solid(&b, -1, 0, 0.5f), middle = add_solid(&b, 0, 0, 1.5f);
    world *w = build_world(&b);
    const world_material *m = w->materials;
    assert_int_equal(w->media_count, 6);
    assert_true(m[last].medium < m[large].medium && m[large].medium < m[middle].medium &&
                m[middle].medium < m[small].medium && m[small].medium < m[first].medium && m[last].medium == 1);
    assert_true(RUNS(w, NESTED_MEDIA));
    world_destroy(w);
    builder_free(&b);
}

/* A thickness of 0, or no way in, is no solid. */
static void walls_are_no_solids(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_material wall = solid(0), opaque = solid(0);
    wall.thickness.value = 0, opaque.transmission.value = 0;
    kiln_id ids[] = {add_cube(&b, &wall, 0, 1), add_cube(&b, &opaque, 0, 1)};
    world *w = build_world(&b);
    assert_int_equal(w->media_count, 1);
    for (int i = 0; i < 2; i++) assert_int_equal(w->materials[ids[i]].medium, 0);
    world_destroy(w);
    builder_free(&b);
}

/* Solids whose boxes meet may touch; those that lie apart cannot, and nothing is asked of them. */
static void neighbours_may_touch(void **state) {
    (void)state;
    static const struct { float x; bool touches; } rows[] = {{1.5f, true}, {2, true}, {2.01f, false}};
    for (int i = 0; i < 3; i++) {
        scene_builder b = builder_make();
        add_solid(&b, 0, 0, 1), add_solid(&b, 0, rows[i].x, 1);
        world *w = build_world(&b);
        assert_int_equal(RUNS(w, NESTED_MEDIA), rows[i].touches);
        world_destroy(w);
        builder_free(&b);
    }
}

/* Beer's law; and finite whatever the distance, so that a clear channel stays clear. */
static void media_take_what_they_should(void **state) {
    (void)state;
    static const float distances[] = {2, 1e-38f, 1e-45f, 1e38f, INFINITY};
    for (int i = 0; i < 5; i++) {
        scene_builder b = builder_make();
        kiln_material m = solid(0);
        m.attenuation_distance = distances[i];
        m.attenuation_color[0] = 1, m.attenuation_color[1] = 0.5f, m.attenuation_color[2] = 0;
        kiln_id id = add_cube(&b, &m, 0, 1);
        world *w = build_world(&b);
        const float *sigma = w->extinction + 3 * w->materials[id].medium;
        assert_true(sigma[0] == 0 && isfinite(sigma[1]) && isfinite(sigma[2]) && sigma[1] <= sigma[2]);
        if (i == 0) assert_true(fabs((double)sigma[1] * w->scale - log(2) / 2) < 1e-6);
        if (i == 0) assert_true(fabs((double)sigma[2] * w->scale - log(1e9) / 2) < 1e-4);
        if (i == 1 || i == 2) assert_true(sigma[1] > 1e29f);
        world_destroy(w);
        builder_free(&b);
    }
}

/* A camera's media are those around it, the highest first. */
static void cameras_know_where_they_are(void **state) {
    (void)state;
    scene_builder b = builder_make();
    kiln_id outer = add_solid(&b, 0, 0, 2), inner = add_solid(&b, 0, 0, 1);
    world *w = build_world(&b);
    const uint64_t o = w->materials[outer].medium, i = w->materials[inner].medium;
    static const float eyes[] = {5, 1.5f, 0.5f};
    const uint64_t expected[] = {0, o, o << 16 | i};
    for (int k = 0; k < 3; k++) {
        kiln_camera view = camera_at((float[]){eyes[k], 0.1f, 0.2f}, (float[]){9, 0, 0}, 40);
        camera c;
        must(camera_make(w, &view, 16, 16, &c, b.report), b.report, "making a camera");
        assert_true(camera_media(w, &c) == expected[k]);
    }
    world_destroy(w);
    builder_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(media_rank),
        cmocka_unit_test(walls_are_no_solids),
        cmocka_unit_test(neighbours_may_touch),
        cmocka_unit_test(media_take_what_they_should),
        cmocka_unit_test(cameras_know_where_they_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
