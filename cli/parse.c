/* Arguments become options: --name value, --name=value, -n value, -nvalue; "--" ends them. */
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "job/options.h"

typedef struct parser {
    const cli_command *command;
    cli_args *args;
    int count, next;
    char **arguments;
    uint64_t given;    /* talk options */
    kiln_arena *arena; /* that talk options, which hold no text, do not use */
    kiln_report *report;
} parser;

bool cli_takes_job(const cli_command *c, const option_row *row) {
    return row->also & c->takes || (c->renders && !(row->except & c->takes));
}

bool cli_takes_talk(const cli_command *c, const option_row *row) {
    const char *at = strstr(c->talk, row->name);
    return at && at > c->talk && at[-1] == ' ' && at[strlen(row->name)] == ' ';
}

/* A row by its name (letter 0) or letter. *talk: in which table. */
static const option_row *find(const parser *p, const char *name, size_t length, char letter, bool *talk) {
    for (int t = 0; t < 2; t++) {
        const option_table *table = t ? &cli_talk_table : &job_option_table;
        for (size_t i = 0; i < table->count; i++) {
            const option_row *row = &table->rows[i];
            bool same =
                letter ? row->letter == letter : strlen(row->name) == length && strncmp(row->name, name, length) == 0;
            *talk = t == 1;
            if (same && (t ? cli_takes_talk(p->command, row) : cli_takes_job(p->command, row))) return row;
        }
    }
    return NULL;
}

static bool unknown(const parser *p, const char *argument, size_t length) {
    const char *names[80], *nearest;
    size_t count = 0;
    kiln_text word = {0}, remedy = {0};
    for (int t = 0; t < 2; t++) {
        const option_table *table = t ? &cli_talk_table : &job_option_table;
        for (size_t i = 0; i < table->count && count < sizeof names / sizeof *names; i++)
            if (t ? cli_takes_talk(p->command, &table->rows[i]) : cli_takes_job(p->command, &table->rows[i]))
                names[count++] = table->rows[i].name;
    }
    text_append_bytes(&word, argument, length);
    const char *bare = word.data && strncmp(word.data, "--", 2) == 0 ? word.data + 2 : "";
    nearest = text_nearest(bare, names, count);
    if (nearest) text_format(&remedy, "did you mean --%s?", nearest);
    else text_format(&remedy, "'kiln %s --help' lists the options", p->command->name);
    report_error(p->report, KILN_CODE_USAGE, NULL, remedy.data, "unknown option '%s'",
                 word.data ? word.data : argument);
    text_free(&word);
    text_free(&remedy);
    return false;
}

static bool set(parser *p, const option_row *row, bool talk, const char *value) {
    if (!talk && strcmp(row->name, "output") == 0 && strcmp(value, "-") == 0) p->args->picture_on_stdout = true;
    if (!talk && strcmp(row->name, "output") == 0) p->args->folder = value;
    if (!talk) return kiln_job_set(p->args->job, row->name, value, p->report);
    kiln_text flag = {0};
    text_format(&flag, "--%s", row->name);
    kiln_where where = where_root(flag.data ? flag.data : row->name);
    bool done = option_set(&cli_talk_table, row, value, &p->args->talk, &p->given, p->arena, &where, p->report);
    text_free(&flag);
    return done;
}

/* value: what is joined to the option, or NULL. */
static bool take(parser *p, const option_row *row, bool talk, const char *value) {
    if (value || row->kind->is_switch) return set(p, row, talk, value ? value : "true");
    const char *next = p->next < p->count ? p->arguments[p->next] : NULL;
    if (!next || strncmp(next, "--", 2) == 0) {
        kiln_text flag = {0};
        text_format(&flag, "--%s %s", row->name, row->argument);
        report_error(p->report, KILN_CODE_USAGE, NULL, flag.data, "option '--%s' needs a value", row->name);
        text_free(&flag);
        return false;
    }
    p->next++;
    return set(p, row, talk, next);
}

static bool parse_long(parser *p, const char *argument) {
    bool talk;
    size_t length = strcspn(argument + 2, "=");
    const option_row *row = find(p, argument + 2, length, 0, &talk);
    if (!row) return unknown(p, argument, length + 2);
    return take(p, row, talk, argument[2 + length] ? argument + 3 + length : NULL);
}

/* -qv, -o file, -ofile */
static bool parse_short(parser *p, const char *argument) {
    for (const char *letter = argument + 1; *letter; letter++) {
        bool talk;
        const option_row *row = find(p, NULL, 0, *letter, &talk);
        if (!row) return unknown(p, argument, strlen(argument));
        if (!row->kind->is_switch) return take(p, row, talk, letter[1] ? letter + 1 : NULL);
        if (!set(p, row, talk, "true")) return false;
    }
    return true;
}

static bool parse_positional(parser *p, const char *argument) {
    if (!p->command->argument)
        return report_error(p->report, KILN_CODE_USAGE, NULL, NULL, "kiln %s takes no argument '%s'", p->command->name,
                            argument);
    const char **slot = p->args->scene && p->command->two ? &p->args->other : &p->args->scene;
    if (*slot)
        return report_error(p->report, KILN_CODE_USAGE, NULL, "call it once for each",
                            "'%s' and '%s': kiln %s takes one %s", *slot, argument, p->command->name,
                            p->command->argument);
    *slot = argument;
    return true;
}

/* The environment goes before the command line, which overrides it. */
static bool take_environment(parser *p) {
    const char *threads = getenv("KILN_THREADS");
    const option_row *row = option_find(&job_option_table, "threads");
    uint64_t number;
    if (!threads || !*threads || !cli_takes_job(p->command, row)) return true;
    kiln_where where = where_root("KILN_THREADS");
    if (!text_to_uint64(threads, &number) || (double)number < row->low || (double)number > row->high)
        return report_error(p->report, KILN_CODE_USAGE, &where, "unset it, or correct it", "'%s' is not %s", threads,
                            row->domain);
    return kiln_job_set(p->args->job, "threads", threads, p->report);
}

bool cli_parse(const cli_command *command, int count, char **arguments, cli_args *args, kiln_report *report) {
    kiln_arena arena = {0};
    parser p = {
        .command = command, .args = args, .count = count, .arguments = arguments, .arena = &arena, .report = report};
    bool done = option_defaults(&cli_talk_table, &args->talk, &arena) && take_environment(&p), options = true;
    while (done && p.next < count) {
        const char *argument = arguments[p.next++];
        if (options && strcmp(argument, "--") == 0) options = false;
        else if (options && strncmp(argument, "--", 2) == 0) done = parse_long(&p, argument);
        else if (options && argument[0] == '-' && argument[1]) done = parse_short(&p, argument);
        else done = parse_positional(&p, argument);
        if (args->talk.help) break; /* whatever else is wrong */
    }
    arena_free(&arena);
    if (done && args->picture_on_stdout && args->talk.json)
        return report_error(report, KILN_CODE_USAGE, NULL, "write the statistics to a file with --stats FILE.json",
                            "--json and -o - both want standard output");
    return done;
}
