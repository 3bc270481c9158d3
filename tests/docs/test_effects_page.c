/* docs/effects.md against the table that it shows. KILN_GOLDEN_UPDATE=1 writes the page's table anew. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/text.h"
#include "kiln/effects.h"

static const char page[] = KILN_SOURCE_DIR "/docs/effects.md", begin[] = "<!-- begin: effects -->\n", end[] = "<!-- end -->";

static void append_cell(kiln_text *t, const char *label, const char *text, const char *before) {
    if (*text) text_format(t, "%s%s%s", before, label, text);
}

static void print_table(kiln_text *t) {
    text_append(t, "| effect | called for by | what follows | |\n| --- | --- | --- | --- |\n");
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) {
        kiln_effect_facts f = kiln_effect_describe((kiln_effect)e);
        text_format(t, "| `%s` | %s | %s", f.name, f.called_for_by, f.stages);
        append_cell(t, "", f.terms, ". Terms: ");
        append_cell(t, "", f.embree, ". Embree: ");
        append_cell(t, "", f.samples, ". Numbers: ");
        text_format(t, " | %s%s |\n", f.held ? "" : "free", f.removable ? "" : f.held ? "always there" : ", always there");
    }
}

static char *read_all(void) {
    FILE *f = fopen(page, "rb");
    assert_non_null(f);
    char *text = calloc(1, 1 << 20);
    size_t length = fread(text, 1, (1 << 20) - 1, f);
    fclose(f);
    assert_true(length > 0);
    return text;
}

static void the_page_shows_the_table(void **state) {
    (void)state;
    kiln_text table = {0}, whole = {0};
    char *text = read_all(), *from = strstr(text, begin), *to;
    assert_non_null(from);
    from += strlen(begin);
    to = strstr(from, end);
    assert_non_null(to);
    print_table(&table);
    text_format(&whole, "%.*s%s%s", (int)(from - text), text, table.data, to);
    if (getenv("KILN_GOLDEN_UPDATE")) {
        FILE *f = fopen(page, "wb");
        assert_non_null(f);
        fwrite(whole.data, 1, strlen(whole.data), f);
        fclose(f);
    } else if (strcmp(whole.data, text) != 0)
        fail_msg("docs/effects.md does not show the table of kiln/effects.h: run this test with KILN_GOLDEN_UPDATE=1");
    text_free(&table);
    text_free(&whole);
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_page_shows_the_table)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
