#include "tests/golden/golden.h"

#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"

bool golden_updates(void) {
    const char *update = getenv("KILN_GOLDEN_UPDATE");
    return update && strcmp(update, "1") == 0;
}

static char *data_path(const char *name) {
    kiln_text path = {0};
    text_format(&path, "%s/%s", KILN_TEST_DATA, name);
    return text_take(&path);
}

static bool read_kept(const char *name, kiln_bytes *bytes) {
    char *path = data_path(name);
    kiln_report *report = kiln_report_create();
    bool read = file_read(path, SIZE_MAX / 2, bytes, NULL, report);
    if (!read) printf("%s: %s\n", path, kiln_report_message(report, 0).what);
    kiln_report_destroy(report);
    free(path);
    return read;
}

static bool write_kept(const char *name, const char *text) {
    char *path = data_path(name);
    kiln_report *report = kiln_report_create();
    bool written = file_replace(path, text, strlen(text), report);
    printf("%s %s\n", written ? "wrote" : "cannot write", path);
    kiln_report_destroy(report);
    free(path);
    return written;
}

/* Two lines of words: alike, or numbers that differ by no more than the tolerance's part of the greater. */
static bool close_lines(const char *a, const char *b, double tolerance) {
    for (;;) {
        a += strspn(a, " "), b += strspn(b, " ");
        size_t n = strcspn(a, " \n"), m = strcspn(b, " \n");
        if (n == 0 || m == 0) return n == m;
        char *a_end, *b_end;
        double x = strtod(a, &a_end), y = strtod(b, &b_end);
        bool numbers = a_end == a + n && b_end == b + m;
        if (numbers ? !(fabs(x - y) <= tolerance * fmax(fabs(x), fabs(y))) : n != m || memcmp(a, b, n) != 0) return false;
        a += n, b += m;
    }
}

static bool same_lines(const char *a, const char *b) {
    size_t n = strcspn(a, "\n");
    return n == strcspn(b, "\n") && memcmp(a, b, n) == 0;
}

static bool compare(const char *name, const char *kept, const char *text, double tolerance) {
    int line = 1;
    while (*kept && *text) {
        if (!same_lines(kept, text) && !(tolerance > 0 && close_lines(kept, text, tolerance))) break;
        size_t a = strcspn(kept, "\n"), b = strcspn(text, "\n");
        kept += a + (kept[a] == '\n');
        text += b + (text[b] == '\n');
        line++;
    }
    if (!*kept && !*text) return true;
    printf("%s, line %d:\n  kept: %.*s\n  now:  %.*s\n", name, line, (int)strcspn(kept, "\n"), kept, (int)strcspn(text, "\n"),
           text);
    return false;
}

bool golden_matches(const char *name, const char *text) { return golden_matches_within(name, text, 0); }

bool golden_matches_within(const char *name, const char *text, double tolerance) {
    if (golden_updates()) return write_kept(name, text);
    kiln_bytes kept;
    if (!read_kept(name, &kept)) return false;
    bool same = compare(name, (const char *)kept.data, text, tolerance);
    file_free(&kept);
    return same;
}

/* nftw has no argument for its caller. */
static struct {
    const char *root, *const *suffixes;
    char **paths;
    size_t count;
} found;

static int visit(const char *path, const struct stat *status, int kind, struct FTW *where) {
    (void)status, (void)where;
    size_t length = strlen(path);
    for (size_t i = 0; kind == FTW_F && found.suffixes[i]; i++) {
        size_t suffix = strlen(found.suffixes[i]);
        if (length < suffix || strcmp(path + length - suffix, found.suffixes[i]) != 0) continue;
        found.paths = realloc(found.paths, (found.count + 1) * sizeof *found.paths);
        found.paths[found.count++] = strdup(path + strlen(found.root) + 1);
    }
    return 0;
}

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

static void append_section(kiln_text *text, const char *root, const char *path,
                           void (*describe)(const char *path, kiln_text *)) {
    kiln_text whole = {0};
    text_format(&whole, "%s/%s", root, path);
    text_format(text, "== %s\n", path);
    describe(whole.data, text);
    text_free(&whole);
}

static bool update_files(const char *name, const char *root, const char *const *suffixes,
                         void (*describe)(const char *path, kiln_text *)) {
    found.root = root;
    found.suffixes = suffixes;
    nftw(root, visit, 16, FTW_PHYS);
    qsort(found.paths, found.count, sizeof *found.paths, by_name);
    kiln_text text = {0};
    for (size_t i = 0; i < found.count; i++) {
        append_section(&text, root, found.paths[i], describe);
        free(found.paths[i]);
    }
    free(found.paths);
    found.paths = NULL;
    found.count = 0;
    bool written = write_kept(name, text.data ? text.data : "");
    text_free(&text);
    return written;
}

/* The section that begins at *at, which moves behind it. */
static bool check_section(const char *name, const char *root, char **at, void (*describe)(const char *path, kiln_text *)) {
    char *next = strstr(*at, "\n== ");
    if (next) *next = '\0'; /* its newline; the text below ends in one too */
    char *section = *at, *path = strndup(section + 3, strcspn(section + 3, "\n"));
    *at = next ? next + 1 : section + strlen(section);
    kiln_text whole = {0}, now = {0}, kept = {0};
    text_format(&whole, "%s/%s", root, path);
    bool same = true;
    if (access(whole.data, R_OK) != 0) printf("  (no %s)\n", path);
    else {
        text_append(&kept, section);
        if (next) text_append(&kept, "\n");
        append_section(&now, root, path, describe);
        same = compare(path, kept.data, now.data, 0);
        if (!same) printf("  in %s\n", name);
    }
    text_free(&whole);
    text_free(&now);
    text_free(&kept);
    free(path);
    return same;
}

bool golden_matches_files(const char *name, const char *root, const char *const *suffixes,
                          void (*describe)(const char *path, kiln_text *)) {
    if (golden_updates()) return update_files(name, root, suffixes, describe);
    kiln_bytes kept;
    if (!read_kept(name, &kept)) return false;
    bool same = true;
    for (char *at = (char *)kept.data; strncmp(at, "== ", 3) == 0;) same &= check_section(name, root, &at, describe);
    file_free(&kept);
    return same;
}
