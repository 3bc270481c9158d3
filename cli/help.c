#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "cli/cli.h"
#include "cli/log.h"
#include "job/options.h"

enum { INDENT = 30, WIDTH = 100 };

bool cli_print(const char *text, kiln_report *report) {
    bool ends = *text && text[strlen(text) - 1] == '\n';
    kiln_writer *writer = file_create("-", report);
    if (!writer) return false;
    file_write(writer, text, strlen(text));
    if (!ends) file_write(writer, "\n", 1);
    return file_commit(writer, report);
}

/* Breaks a text at blanks; it starts in column `column`. */
static void append_wrapped(kiln_text *out, const char *text, size_t column) {
    for (const char *word = text; *word;) {
        size_t length = strcspn(word, " ");
        if (column + 1 + length > WIDTH && column > INDENT) {
            text_format(out, "\n%*s", INDENT, "");
            column = INDENT;
        }
        if (column > INDENT) text_append(out, " ");
        text_append_bytes(out, word, length);
        column += length + (column > INDENT);
        word += length + strspn(word + length, " ");
    }
    text_append(out, "\n");
}

static void append_option(kiln_text *out, const option_row *row) {
    kiln_text name = {0}, help = {0};
    if (row->letter) text_format(&name, "  -%c, --%s", row->letter, row->name);
    else text_format(&name, "      --%s", row->name);
    if (row->argument) text_format(&name, " %s", row->argument);
    text_append(&help, row->help);
    const char *fallback = row->shown ? row->shown : row->fallback;
    if (fallback) text_format(&help, " [%s]", fallback);
    text_append(out, name.data ? name.data : "");
    if (name.length + 2 > INDENT) text_format(out, "\n%*s", INDENT, "");
    else text_format(out, "%*s", (int)(INDENT - name.length), "");
    append_wrapped(out, help.data ? help.data : "", INDENT);
    text_free(&name);
    text_free(&help);
}

static void append_options(kiln_text *out, const cli_command *c) {
    const char *group = "";
    for (int t = 0; t < 2; t++) {
        const option_table *table = t ? &cli_talk_table : &job_option_table;
        for (size_t i = 0; i < table->count; i++) {
            const option_row *row = &table->rows[i];
            if (!(t ? cli_takes_talk(c, row) : cli_takes_job(c, row))) continue;
            if (strcmp(group, row->group) != 0) text_format(out, "\n%s\n", row->group);
            group = row->group;
            append_option(out, row);
        }
    }
}

bool cli_print_text(kiln_text *text, kiln_report *report) {
    bool done = text->data ? cli_print(text->data, report) : report_no_memory(report, "printing");
    text_free(text);
    return done;
}

bool cli_print_help(const cli_command *c, kiln_report *report) {
    kiln_text out = {0};
    text_format(&out, "kiln %s%s%s [options]: %s\n", c->name, c->argument ? " " : "", c->argument ? c->argument : "",
                c->summary);
    append_options(&out, c);
    if (c->examples) text_format(&out, "\nExamples\n%s\n", c->examples);
    return cli_print_text(&out, report);
}

bool cli_print_overview(kiln_report *report) {
    kiln_text out = {0};
    text_format(&out, "kiln %s: a physically based renderer for glTF assets\n\n", kiln_version());
    for (size_t i = 0; cli_commands[i]; i++) {
        const cli_command *c = cli_commands[i];
        text_format(&out, "  kiln %-8s %-8s %s\n", c->name, c->argument ? c->argument : "", c->summary);
    }
    text_append(&out, "\n'kiln COMMAND --help' explains the options. Try: kiln render helmet.glb\n");
    return cli_print_text(&out, report);
}

static int run_help(const cli_command *command, cli_args *args, kiln_report *report) {
    (void)command;
    const cli_command *asked = NULL;
    for (size_t i = 0; args->scene && cli_commands[i]; i++)
        if (strcmp(cli_commands[i]->name, args->scene) == 0) asked = cli_commands[i];
    if (!args->scene) cli_print_overview(report);
    else if (asked) cli_print_help(asked, report);
    else
        report_error(report, KILN_CODE_USAGE, NULL, "'kiln help' lists the commands", "unknown command '%s'",
                     args->scene);
    return kiln_report_exit_code(report);
}

static int run_version(const cli_command *command, cli_args *args, kiln_report *report) {
    (void)command, (void)args;
    kiln_text out = {0};
    text_format(&out, "kiln %s\n", kiln_version());
    cli_print_text(&out, report);
    return kiln_report_exit_code(report);
}

const cli_command cli_help = {.name = "help",
                              .argument = "COMMAND",
                              .summary = "this text, or the options of a command",
                              .talk = " help ",
                              .run = run_help};
const cli_command cli_version = {
    .name = "version", .summary = "the version of kiln", .talk = " help ", .run = run_version};
