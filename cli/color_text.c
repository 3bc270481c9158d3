#include "cli/color_text.h"

void append_names(kiln_text *out, const char *heading, const json_t *names) {
    const json_t *name;
    size_t i;
    text_format(out, "  %-12s ", heading);
    json_array_foreach(names, i, name) {
        text_append(out, i ? ", " : "");
        append_name(out, json_string_value(name), 0);
    }
    text_append(out, json_array_size(names) ? "\n" : "none\n");
}

void append_color(kiln_text *out, const json_t *color) {
    const json_t *display;
    size_t i;
    text_format(out, "  config       %s\n  default      %s\n", text_in(color, "config"),
                text_in(color, "default"));
    json_array_foreach(member(color, "displays"), i, display) {
        text_append(out, i ? "               " : "  displays     ");
        append_name(out, text_in(display, "name"), 0);
        const json_t *view;
        size_t k;
        json_array_foreach(member(display, "views"), k, view) {
            text_append(out, k ? ", " : ": ");
            append_name(out, json_string_value(view), 0);
        }
        text_append(out, "\n");
    }
    append_names(out, "looks", member(color, "looks"));
    append_names(out, "spaces", member(color, "spaces"));
}
