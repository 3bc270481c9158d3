#include "cli/inspect_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "cli/json_text.h"

/* Rows of a list that are shown unless all are asked for. */
enum { SHOWN = 40, NAME_WIDTH_MAX = 64 };

typedef struct printer {
    kiln_text *out;
    const json_t *root;
    bool all;
} printer;

static void print_count(const printer *p, const char *before, double count, const char *noun, const char *plural) {
    text_append(p->out, before);
    append_grouped(p->out, count);
    text_format(p->out, " %s", count == 1 ? noun : plural);
}

static void print_source(const printer *p) {
    const json_t *source = member(p->root, "source"), *row;
    size_t i;
    append_name(p->out, text_in(source, "file"), 0);
    text_append(p->out, "\n  format       ");
    append_name(p->out, is_null(source, "format") ? "unknown" : text_in(source, "format"), 0);
    if (!is_null(source, "generator")) {
        text_append(p->out, ", written by ");
        append_name(p->out, text_in(source, "generator"), 0);
    }
    text_append(p->out, "\n");
    json_array_foreach(member(source, "extensions"), i, row) {
        text_append(p->out, i ? "               " : "  extensions   ");
        append_name(p->out, text_in(row, "name"), 0);
        text_format(p->out, "%s: ", is_true(row, "required") ? " (required)" : "");
        append_name(p->out, text_in(row, "support"), 0);
        text_append(p->out, "\n");
    }
}

static void print_counts(const printer *p) {
    const json_t *c = member(p->root, "counts"), *b = member(p->root, "bounds");
    print_count(p, "  contents     ", number_in(c, "instances"), "instance", "instances");
    print_count(p, " of ", number_in(c, "meshes"), "mesh", "meshes");
    print_count(p, ", ", number_in(c, "triangles"), "triangle", "triangles");
    if (number_in(c, "triangles_unique") != number_in(c, "triangles_before_subdivision"))
        print_count(p, " (", number_in(c, "triangles_before_subdivision"), "before subdivision)",
                    "before subdivision)");
    print_count(p, ", ", number_in(c, "materials"), "material", "materials");
    print_count(p, ", ", number_in(c, "images"), "image", "images");
    print_count(p, ", ", number_in(c, "lights"), "light", "lights");
    print_count(p, ", ", number_in(c, "cameras"), "camera", "cameras");
    text_append(p->out, "\n  size         ");
    if (json_is_object(b)) {
        const json_t *size = member(b, "size");
        for (size_t k = 0; k < 3; k++)
            text_format(p->out, "%s%.4g", k ? " x " : "", json_number_value(json_array_get(size, k)));
        text_append(p->out, " m, from ");
        append_vector(p->out, member(b, "min"));
        text_append(p->out, " to ");
        append_vector(p->out, member(b, "max"));
    } else text_append(p->out, "nothing");
    text_append(p->out, "\n");
}

/* The width of the column of names. */
static size_t column(const json_t *rows) {
    size_t width = 4, i;
    const json_t *row;
    json_array_foreach(rows, i, row) {
        size_t own = name_width(text_in(row, "name"));
        if (own > width) width = own;
    }
    return width < NAME_WIDTH_MAX ? width : NAME_WIDTH_MAX;
}

/* Calls print_row for the rows of a list under a heading. */
static void print_list(const printer *p, const char *heading, const char *key,
                       void (*print_row)(const printer *, const json_t *row)) {
    const json_t *rows = member(p->root, key), *row;
    size_t i, count = json_array_size(rows), width = column(rows);
    if (!count) return;
    text_format(p->out, "\n%s\n", heading);
    json_array_foreach(rows, i, row) {
        if (i == SHOWN && !p->all) {
            text_format(p->out, "  … %zu more; -v lists all\n", count - i);
            break;
        }
        text_format(p->out, "%5zu  ", i);
        append_name(p->out, text_in(row, "name"), width);
        text_append(p->out, "  ");
        print_row(p, row);
        text_append(p->out, "\n");
    }
}

/* ", mesh 3 Wheel": what a row refers to, by its place in another list. */
static void print_reference(const printer *p, const json_t *row, const char *key, const char *list, const char *before) {
    if (is_null(row, key)) return;
    text_format(p->out, "%s%s %.0f ", before, key, number_in(row, key));
    append_name(p->out, text_in(json_array_get(member(p->root, list), (size_t)number_in(row, key)), "name"), 0);
}

/* The tree by indentation; no deeper than lines are wide. */
static void print_nodes(const printer *p) {
    enum { INDENT_MAX = 32 };
    const json_t *rows = member(p->root, "nodes"), *row;
    size_t i, count = json_array_size(rows);
    size_t *depth = array_alloc(count, sizeof *depth);
    if (!count || !depth) {
        free(depth);
        return;
    }
    text_append(p->out, "\nNodes\n");
    json_array_foreach(rows, i, row) {
        if (i == SHOWN && !p->all) {
            text_format(p->out, "  … %zu more; -v lists all\n", count - i);
            break;
        }
        depth[i] = is_null(row, "parent") ? 0 : depth[(size_t)number_in(row, "parent")] + 1;
        text_format(p->out, "%5zu  %*s", i, (int)(2 * (depth[i] < INDENT_MAX ? depth[i] : INDENT_MAX)), "");
        append_name(p->out, *text_in(row, "name") ? text_in(row, "name") : "-", 0);
        print_reference(p, row, "mesh", "meshes", ": ");
        print_reference(p, row, "camera", "cameras", ": ");
        print_reference(p, row, "light", "lights", ": ");
        text_append(p->out, "\n");
    }
    free(depth);
}

static void print_instance(const printer *p, const json_t *row) {
    const json_t *name;
    size_t i;
    print_reference(p, row, "mesh", "meshes", "");
    json_array_foreach(member(row, "materials"), i, name) {
        text_append(p->out, i ? ", " : ", of ");
        append_name(p->out, *json_string_value(name) ? json_string_value(name) : "-", 0);
    }
    text_append(p->out, " at ");
    append_vector(p->out, member(row, "position"));
}

static void print_mesh(const printer *p, const json_t *row) {
    const json_t *s = member(row, "subdivision"), *name;
    size_t i;
    print_count(p, "", number_in(row, "triangles"), "triangle", "triangles");
    print_count(p, ", ", number_in(row, "vertices"), "vertex", "vertices");
    text_append(p->out, ";");
    json_array_foreach(member(row, "primvars"), i, name) text_format(p->out, " %s", json_string_value(name));
    if (!s) return;
    text_append(p->out, "; ");
    if (is_true(s, "refined"))
        text_format(p->out, "refined, %s level %.0f: ", text_in(s, "scheme"), number_in(s, "level"));
    else text_append(p->out, "not refined: ");
    append_name(p->out, text_in(s, "reason"), 0);
}

static void print_texture(const printer *p, const json_t *t) {
    const json_t *image = json_array_get(member(p->root, "images"), (size_t)number_in(t, "image"));
    text_format(p->out, "\n           %-15s image %.0f", text_in(t, "slot"), number_in(t, "image"));
    if (!is_null(image, "width"))
        text_format(p->out, ", %.0f x %.0f", number_in(image, "width"), number_in(image, "height"));
    text_format(p->out, ", %s, uv %.0f", text_in(t, "transfer"), number_in(t, "uv_set"));
}

static void print_material(const printer *p, const json_t *row) {
    const json_t *item;
    size_t i;
    bool glossy = false; /* roughness is told as its opposite */
    text_format(p->out, "%s%s", text_in(row, "alpha_mode"), is_true(row, "double_sided") ? ", double-sided" : "");
    json_array_foreach(member(row, "layers"), i, item) {
        text_format(p->out, ", %s", json_string_value(item));
        glossy |= strcmp(json_string_value(item), "glossiness") == 0;
    }
    text_append(p->out, "; color ");
    append_vector(p->out, member(row, "base_color"));
    text_format(p->out, ", metallic %.3g, %s %.3g, ior %.3g", number_in(row, "metallic"),
                glossy ? "glossiness" : "roughness", number_in(row, "roughness"), number_in(row, "ior"));
    double emission = 0;
    json_array_foreach(member(row, "emission"), i, item) emission = fmax(emission, json_number_value(item));
    if (emission > 0) {
        text_append(p->out, ", emission ");
        append_vector(p->out, member(row, "emission"));
    }
    json_array_foreach(member(row, "textures"), i, item) print_texture(p, item);
}

static void print_image(const printer *p, const json_t *row) {
    if (is_null(row, "format")) {
        text_append(p->out, "cannot be read");
        return;
    }
    text_format(p->out, "%s, %.0f x %.0f, %.0f channel%s of %.0f bits", text_in(row, "format"), number_in(row, "width"),
                number_in(row, "height"), number_in(row, "channels"), number_in(row, "channels") == 1 ? "" : "s",
                number_in(row, "bits"));
}

static void print_light(const printer *p, const json_t *row) {
    text_format(p->out, "%s, %.4g %s, color ", text_in(row, "kind"), number_in(row, "intensity"), text_in(row, "unit"));
    append_vector(p->out, member(row, "color"));
    if (!is_null(row, "outer_cone_deg"))
        text_format(p->out, ", cone %.3g to %.3g degrees", number_in(row, "inner_cone_deg"),
                    number_in(row, "outer_cone_deg"));
}

static void print_camera(const printer *p, const json_t *row) {
    text_append(p->out, text_in(row, "projection"));
    if (!is_null(row, "fov_deg")) text_format(p->out, ", %.3g degrees high", number_in(row, "fov_deg"));
    else text_format(p->out, ", %.4g m high", number_in(row, "height"));
    if (!is_null(row, "aspect")) text_format(p->out, ", aspect %.4g", number_in(row, "aspect"));
    text_append(p->out, ", at ");
    append_vector(p->out, member(row, "position"));
}

static void print_rendering(const printer *p) {
    const json_t *r = member(p->root, "rendering"), *m = member(p->root, "memory_estimate");
    static const char *const parts[] = {"textures", "geometry", "acceleration", "film"};
    text_format(p->out, "\nRendering\n  picture      %.0f x %.0f\n  camera       ", number_in(r, "width"),
                number_in(r, "height"));
    append_name(p->out, text_in(member(r, "camera"), "name"), 0);
    text_append(p->out, ", ");
    print_camera(p, member(r, "camera"));
    text_append(p->out, "\n  light        ");
    append_name(p->out, text_in(r, "light"), 0);
    text_append(p->out, "\n  memory       about ");
    append_bytes(p->out, number_in(m, "total"));
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        text_format(p->out, "%s %s ", i ? "," : ":", parts[i]);
        append_bytes(p->out, number_in(m, parts[i]));
    }
    text_append(p->out, "\n");
}

/* "by material 3 Leaves, material 5 Grass and 4 more" */
static void print_callers(const printer *p, const json_t *row) {
    const json_t *callers = member(row, "callers"), *c;
    size_t i;
    json_array_foreach(callers, i, c) {
        text_format(p->out, "%s%s", i ? ", " : "by ", text_in(c, "kind"));
        if (!is_null(c, "index")) text_format(p->out, " %.0f", number_in(c, "index"));
        if (strcmp(text_in(c, "name"), text_in(c, "kind")) != 0) {
            text_append(p->out, " ");
            append_name(p->out, text_in(c, "name"), 0);
        }
    }
    double more = number_in(row, "caller_count") - (double)json_array_size(callers);
    if (more > 0) text_format(p->out, " and %.0f more", more);
}

static void print_effect(const printer *p, const json_t *row) {
    static const char *const follows[] = {"stages", "terms", "embree", "samples"};
    text_format(p->out, "  %-20s ", text_in(row, "name"));
    if (is_true(row, "called")) print_callers(p, row);
    else text_append(p->out, "as --effects asks");
    for (size_t i = 0; p->all && i < sizeof follows / sizeof *follows; i++)
        if (*text_in(row, follows[i]))
            text_format(p->out, "\n  %-20s   %s: %s", "", follows[i], text_in(row, follows[i]));
    if (number_in(row, "bytes") > 0) {
        text_append(p->out, ", ");
        append_bytes(p->out, number_in(row, "bytes"));
    }
    text_append(p->out, "\n");
}

static void print_effects(const printer *p) {
    const json_t *rows = member(p->root, "effects"), *row;
    enum { LINE_WIDTH = 110 };
    size_t i, idle = 0, width = 0;
    text_append(p->out, "\nEffects\n");
    json_array_foreach(rows, i, row)
        if (is_true(row, "called") || is_true(row, "runs")) print_effect(p, row);
    json_array_foreach(rows, i, row) {
        if (is_true(row, "called") || is_true(row, "runs")) continue;
        const char *name = text_in(row, "name");
        bool wraps = width + strlen(name) > LINE_WIDTH;
        text_append(p->out, !idle++ ? "  not called for       " : wraps ? ",\n                       " : ", ");
        text_append(p->out, name);
        width = (width && !wraps ? width + 2 : 23) + strlen(name);
    }
    if (idle) text_append(p->out, "\n");
}

void inspect_text(const char *json, bool all, kiln_text *out) {
    json_t *root = json_loads(json, 0, NULL);
    const printer p = {out, root, all};
    if (!root) return;
    print_source(&p);
    print_counts(&p);
    print_nodes(&p);
    print_list(&p, "Instances", "instances", print_instance);
    print_list(&p, "Meshes", "meshes", print_mesh);
    print_list(&p, "Materials", "materials", print_material);
    print_list(&p, "Images", "images", print_image);
    print_list(&p, "Lights", "lights", print_light);
    print_list(&p, "Cameras", "cameras", print_camera);
    print_effects(&p);
    print_rendering(&p);
    json_decref(root);
}
