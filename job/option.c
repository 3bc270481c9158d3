#include "job/option.h"

#include <math.h>
#include <string.h>

static bool parse_text(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row;
    *(const char **)field = arena_string(arena, text);
    return true; /* option_set looks at what came of it */
}

static void print_text(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    const char *text = *(const char *const *)field;
    text_append(out, text ? text : "");
}

static bool parse_texts(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row;
    option_list *list = field;
    const char **items = ARENA_ARRAY(arena, const char *, (size_t)list->count + 1);
    if (!items) return false;
    for (uint32_t i = 0; i < list->count; i++) items[i] = list->items[i];
    if (!(items[list->count] = arena_string(arena, text))) return false;
    list->items = items;
    list->count++;
    return *text != '\0';
}

static bool parse_count(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)arena;
    uint64_t value;
    if (!text_to_uint64(text, &value) || (double)value < row->low || (double)value > row->high) return false;
    *(uint32_t *)field = (uint32_t)value;
    return true;
}

static void print_count(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    text_format(out, "%u", *(const uint32_t *)field);
}

static bool parse_integer(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    return text_to_uint64(text, field);
}

static void print_integer(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    text_format(out, "%llu", (unsigned long long)*(const uint64_t *)field);
}

static bool parse_number(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)arena;
    double value;
    if (!text_to_double(text, &value) || value < row->low || value > row->high) return false;
    *(double *)field = value;
    return true;
}

void option_print_number(double value, kiln_text *out) {
    for (int digits = 6; digits <= 17; digits++) {
        kiln_text text = {0};
        double back;
        text_format(&text, "%.*g", digits, value);
        bool same = !text.data || (text_to_double(text.data, &back) && back == value) || !isfinite(value);
        if (same) text_append(out, text.data ? text.data : "");
        text_free(&text);
        if (same) return;
    }
}

static void print_number(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    option_print_number(*(const double *)field, out);
}

static bool parse_toggle(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)row, (void)arena;
    bool on = strcmp(text, "true") == 0;
    if (!on && strcmp(text, "false") != 0) return false;
    *(bool *)field = on;
    return true;
}

static void print_toggle(const option_row *row, const void *field, kiln_text *out) {
    (void)row;
    text_append(out, *(const bool *)field ? "true" : "false");
}

static bool parse_choice(const option_row *row, const char *text, void *field, kiln_arena *arena) {
    (void)arena;
    for (const option_choice *c = row->choices; c->name; c++)
        if (strcmp(text, c->name) == 0) {
            memcpy(field, &c->value, sizeof c->value); /* an enum is as large as an int */
            return true;
        }
    return false;
}

static void print_choice(const option_row *row, const void *field, kiln_text *out) {
    int value;
    memcpy(&value, field, sizeof value);
    for (const option_choice *c = row->choices; c->name; c++)
        if (c->value == value) {
            text_append(out, c->name);
            return;
        }
}

const option_kind option_text = {parse_text, print_text, false, false};
const option_kind option_texts = {parse_texts, print_text, false, true};
const option_kind option_count = {parse_count, print_count, false, false};
const option_kind option_integer = {parse_integer, print_integer, false, false};
const option_kind option_number = {parse_number, print_number, false, false};
const option_kind option_toggle = {parse_toggle, print_toggle, true, false};
const option_kind option_choices = {parse_choice, print_choice, false, false};

const option_row *option_find(const option_table *table, const char *name) {
    for (size_t i = 0; i < table->count; i++)
        if (strcmp(table->rows[i].name, name) == 0) return &table->rows[i];
    return NULL;
}

/* "give one of box, gaussian (did you mean 'box'?)" */
static bool refuse_choice(const option_row *row, const char *text, const kiln_where *where, kiln_report *report) {
    enum { MOST = 16 };
    const char *names[MOST];
    size_t count = 0;
    kiln_text remedy = {0};
    text_append(&remedy, "give one of ");
    for (const option_choice *c = row->choices; c->name && count < MOST; c++) {
        text_format(&remedy, "%s%s", count ? ", " : "", c->name);
        names[count++] = c->name;
    }
    const char *nearest = text_nearest(text, names, count);
    if (nearest) text_format(&remedy, "; did you mean %s?", nearest);
    report_error(report, KILN_CODE_USAGE, where, remedy.data, "'%s' is not %s", text, row->domain);
    text_free(&remedy);
    return false;
}

static bool refuse(const option_row *row, const char *text, const kiln_where *where, kiln_report *report) {
    kiln_text remedy = {0};
    if (row->choices) return refuse_choice(row, text, where, report);
    if (row->explain) row->explain(text, &remedy);
    report_error(report, KILN_CODE_USAGE, where, remedy.data, "'%s' is not %s", text, row->domain);
    text_free(&remedy);
    return false;
}

bool option_set(const option_table *table, const option_row *row, const char *text, void *fields, uint64_t *given,
                kiln_arena *arena, const kiln_where *where, kiln_report *report) {
    void *field = (char *)fields + row->offset;
    if (!row->kind->parse(row, text, field, arena)) return refuse(row, text, where, report);
    if (row->kind == &option_text && !*(const char **)field) return report_no_memory(report, "reading options");
    *given |= (uint64_t)1 << (row - table->rows);
    return true;
}

bool option_defaults(const option_table *table, void *fields, kiln_arena *arena) {
    for (size_t i = 0; i < table->count; i++) {
        const option_row *row = &table->rows[i];
        if (row->fallback && !row->kind->parse(row, row->fallback, (char *)fields + row->offset, arena)) return false;
    }
    return true;
}

void option_print(const option_row *row, const void *fields, uint32_t index, kiln_text *out) {
    const void *field = (const char *)fields + row->offset;
    if (row->kind->repeats) field = &((const option_list *)field)->items[index];
    row->kind->print(row, field, out);
}

bool option_given(const option_table *table, uint64_t given, size_t offset) {
    for (size_t i = 0; i < table->count; i++)
        if (table->rows[i].offset == offset) return given >> i & 1;
    return false;
}

void option_quote(const char *word, kiln_text *out) {
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:,=+%@";
    if (*word && strspn(word, plain) == strlen(word)) {
        text_append(out, word);
        return;
    }
    text_append(out, "'");
    for (const char *c = word; *c; c++) {
        if (*c == '\'') text_append(out, "'\\''");
        else text_append_bytes(out, c, 1);
    }
    text_append(out, "'");
}

static void print_argument(const option_row *row, const void *fields, uint32_t index, kiln_text *out) {
    kiln_text value = {0};
    option_print(row, fields, index, &value);
    if (row->kind->is_switch)
        text_format(out, strcmp(value.data ? value.data : "", "true") == 0 ? " --%s" : " --%s=false", row->name);
    else {
        text_format(out, " --%s ", row->name);
        option_quote(value.data ? value.data : "", out);
    }
    text_free(&value);
}

void option_print_command(const option_table *table, const void *fields, uint64_t given, kiln_text *out) {
    for (size_t i = 0; i < table->count; i++) {
        const option_row *row = &table->rows[i];
        if (!(given >> i & 1)) continue;
        uint32_t count = row->kind->repeats ? ((const option_list *)((const char *)fields + row->offset))->count : 1;
        for (uint32_t k = 0; k < count; k++) print_argument(row, fields, k, out);
    }
}
