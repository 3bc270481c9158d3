/* The state of standard error, which a process has one of. */
#include "cli/log.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/clock.h"

enum { COUNTS_KEPT = 256 };

static struct {
    log_level level;
    size_t printed;   /* messages of the report */
    uint64_t counts[COUNTS_KEPT]; /* of the first ones, as they were printed */
    bool line_is_up;  /* the progress line */
    double last_line; /* when it was written where there is no terminal */
} state = {.level = LOG_NORMAL};

void log_set_level(log_level level) { state.level = level; }

static bool is_terminal(void) {
    const char *term = getenv("TERM");
    return isatty(STDERR_FILENO) && term && strcmp(term, "dumb") != 0;
}

static bool has_color(void) {
    const char *no = getenv("NO_COLOR");
    return is_terminal() && !(no && *no);
}

static void put(const char *text) {
    fputs(text, stderr);
    fflush(stderr);
}

static void take_line_off(void) {
    if (state.line_is_up) put("\r\033[K");
    state.line_is_up = false;
}

void log_line(log_level level, const char *format, ...) {
    if (level > state.level) return;
    kiln_text line = {0};
    va_list args;
    va_start(args, format);
    text_format_list(&line, format, args);
    va_end(args);
    text_append(&line, "\n");
    take_line_off();
    put(line.data ? line.data : "(out of memory)\n");
    text_free(&line);
}

/* What comes out of a file must not move the cursor or start a line of its own. */
static void append_harmless(kiln_text *out, const char *text) {
    for (const char *c = text; *c; c++) text_append_bytes(out, (unsigned char)*c < 32 || *c == 127 ? "?" : c, 1);
}

static void print_message(const kiln_message *m, const char *again) {
    static const char *const names[] = {[KILN_NOTE] = "note", [KILN_WARNING] = "warning", [KILN_ERROR] = "error"};
    static const char *const colors[] = {
        [KILN_NOTE] = "\033[36m", [KILN_WARNING] = "\033[33m", [KILN_ERROR] = "\033[31m"};
    if (m->severity != KILN_ERROR && state.level < LOG_NORMAL) return;
    kiln_text line = {0};
    text_format(&line, "%s%s:%s ", has_color() ? colors[m->severity] : "", names[m->severity],
                has_color() ? "\033[0m" : "");
    append_harmless(&line, m->where);
    if (*m->where) text_append(&line, ": ");
    append_harmless(&line, m->what);
    if (m->count > 1) text_format(&line, " (%llu times%s)", (unsigned long long)m->count, again);
    if (*m->remedy) {
        text_append(&line, "; ");
        append_harmless(&line, m->remedy);
    }
    text_append(&line, "\n");
    take_line_off();
    put(line.data ? line.data : "(out of memory)\n");
    text_free(&line);
}

void log_flush(const kiln_report *report) {
    for (; state.printed < kiln_report_size(report); state.printed++) {
        kiln_message m = kiln_report_message(report, state.printed);
        print_message(&m, "");
        if (state.printed < COUNTS_KEPT) state.counts[state.printed] = m.count;
    }
}

void log_warning_counts(const kiln_report *report) {
    uint64_t all = kiln_report_count(report, KILN_WARNING);
    for (size_t i = 0; i < state.printed && i < COUNTS_KEPT; i++) {
        kiln_message m = kiln_report_message(report, i);
        if (m.count > state.counts[i]) print_message(&m, " in all");
        state.counts[i] = m.count;
    }
    if (all) log_line(LOG_NORMAL, "%llu warning%s", (unsigned long long)all, all == 1 ? "" : "s");
}

/* "1:05", "2:03:04" */
static void append_time(kiln_text *out, double seconds) {
    long s = lrint(fmin(seconds, 3.6e8));
    if (s >= 3600) text_format(out, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
    else text_format(out, "%ld:%02ld", s / 60, s % 60);
}

/* Numbers keep their columns, so that nothing jumps. */
static void append_facts(kiln_text *out, const kiln_progress *p) {
    text_format(out, " %3.0f%%  %5u spp", 100 * p->fraction, p->spp_done);
    if (p->error >= 0) text_format(out, "  error %5.2f%%", 100 * p->error);
    if (p->seconds_left >= 0) {
        text_append(out, "  ");
        append_time(out, p->seconds_left);
        text_append(out, " left");
    }
}

static size_t terminal_width(void) {
    struct winsize size;
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col ? size.ws_col : 80;
}

enum { FACTS_WIDTH = 50 };

static void draw_bar(const kiln_progress *p) {
    kiln_text facts = {0}, line = {0};
    append_facts(&facts, p);
    size_t width = terminal_width(), cells = width > FACTS_WIDTH + 10 ? width - FACTS_WIDTH : 0;
    if (cells > 40) cells = 40;
    text_append(&line, "\r");
    if (cells) {
        text_append(&line, "[");
        for (size_t i = 0; i < cells; i++) text_append(&line, (double)i < p->fraction * (double)cells ? "#" : ".");
        text_append(&line, "]");
    }
    if (facts.data) text_append_bytes(&line, facts.data, facts.length < width ? facts.length : width - 1);
    text_append(&line, "\033[K");
    if (line.data) put(line.data); /* in one piece: nothing flickers */
    state.line_is_up = true;
    text_free(&facts);
    text_free(&line);
}

/* For files and pipes: a line now and then. */
static void print_line(const kiln_progress *p) {
    kiln_text facts = {0};
    double now = clock_seconds();
    if (now - state.last_line < 1 && p->fraction < 1) return;
    state.last_line = now;
    append_facts(&facts, p);
    text_append(&facts, "\n");
    if (facts.data) put(facts.data + 1);
    text_free(&facts);
}

void log_progress(cli_progress mode, const kiln_progress *p) {
    if (mode == PROGRESS_NEVER || (mode == PROGRESS_AUTO && (state.level < LOG_NORMAL || !is_terminal()))) return;
    if (is_terminal()) draw_bar(p);
    else print_line(p);
}

void log_progress_end(void) { take_line_off(); }
