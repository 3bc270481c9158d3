#include "cli/bench_text.h"

#include <math.h>
#include <string.h>

#include "cli/json_text.h"

static void print_scene(const json_t *root, kiln_text *out) {
    const json_t *scene = member(root, "scene"), *picture = member(root, "picture");
    const char *file = text_in(root, "scene_file");
    append_name(out, *file ? file : "a generated scene", 0);
    text_append(out, ": ");
    append_grouped(out, number_in(scene, "triangles"));
    text_format(out, " triangles, %.0f x %.0f pixels, %.0f samples per pixel, %.0f threads, light %s\n\n",
                number_in(picture, "width"), number_in(picture, "height"), number_in(picture, "samples_per_pixel"),
                number_in(member(root, "machine"), "threads"), text_in(scene, "light"));
}

static void print_start(const json_t *root, kiln_text *out) {
    const json_t *phase;
    size_t i;
    text_append(out, "start         ");
    json_array_foreach(member(root, "phases"), i, phase)
        if (strcmp(text_in(phase, "name"), "measure") != 0)
            text_format(out, "%s%s %.3f s", i ? ", " : "", text_in(phase, "name"), number_in(phase, "seconds"));
    text_format(out, "\n              one sample per pixel after %.3f s\n", number_in(root, "first_sample_seconds"));
}

static void print_rates(const char *name, const json_t *rates, kiln_text *out) {
    text_format(out, "%-13s %.2f M samples/s, %.1f M rays/s", name, number_in(rates, "samples_per_second") * 1e-6,
                number_in(rates, "rays_per_second") * 1e-6);
}

static void print_render(const json_t *render, kiln_text *out) {
    const json_t *seconds, *stage;
    double least = INFINITY, most = 0;
    size_t i;
    json_array_foreach(member(render, "runs"), i, seconds) {
        least = fmin(least, json_number_value(seconds));
        most = fmax(most, json_number_value(seconds));
    }
    print_rates("render", render, out);
    text_format(out, "; the best of %zu runs of %.2f to %.2f s\n", json_array_size(member(render, "runs")), least, most);
    json_array_foreach(member(render, "stages"), i, stage)
        text_format(out, "  %-12s%5.1f%%  %.3f s of threads\n", text_in(stage, "name"), 100 * number_in(stage, "share"),
                    number_in(stage, "seconds"));
    text_format(out, "  %-20s%.3f s\n", "waiting", number_in(render, "waiting_seconds"));
}

static void print_embree(const json_t *embree, kiln_text *out) {
    if (!embree) return;
    print_rates("embree alone", embree, out);
    text_format(out, "; packets of %.1f rays on average\n", number_in(embree, "packet_rays"));
    text_format(out, "              the render runs at %.0f%% of the replay of its rays\n",
                100 * number_in(embree, "render_share"));
}

static void print_memory(const json_t *memory, kiln_text *out) {
    static const char *const parts[] = {"film", "acceleration", "scene", "textures"};
    text_append(out, "memory        peak ");
    append_bytes(out, number_in(memory, "peak"));
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        text_format(out, "%s %s ", i ? "," : ":", parts[i]);
        append_bytes(out, number_in(memory, parts[i]));
    }
    text_append(out, "\n");
}

static void print_growth(const json_t *growth, kiln_text *out) {
    const char *axis;
    const json_t *rows, *row;
    size_t i;
    json_object_foreach((json_t *)growth, axis, rows) {
        text_format(out, "\n%-12s  import s   build s  render s  M samples/s  M rays/s  accel MB  scene MB   film MB   peak MB\n",
                    axis);
        json_array_foreach(rows, i, row) {
            double seconds = number_in(row, "render_seconds");
            text_format(out, "%-12.0f%10.3f%10.3f%10.3f%13.3f%10.2f", number_in(row, "value"),
                        number_in(row, "import_seconds"), number_in(row, "build_seconds"), seconds,
                        number_in(row, "samples_per_second") * 1e-6, number_in(row, "rays") * 1e-6 / seconds);
            text_format(out, "%10.1f%10.1f%10.1f%10.1f\n", number_in(row, "acceleration") * 1e-6,
                        (number_in(row, "scene") + number_in(row, "textures")) * 1e-6, number_in(row, "film") * 1e-6,
                        number_in(row, "peak") * 1e-6);
        }
    }
}

void bench_text(const char *json, kiln_text *out) {
    json_t *root = json_loads(json, 0, NULL);
    print_scene(root, out);
    print_start(root, out);
    print_render(member(root, "render"), out);
    print_embree(member(root, "embree"), out);
    print_memory(member(root, "memory"), out);
    print_growth(member(root, "growth"), out);
    json_decref(root);
}
