/* job/option.h: an option exists once: one row gives its flag, its name in files, its help, its default and its check.
 *
 * A table of rows describes a plain struct; the command line, --help, files of options and metadata all read it. */
#ifndef KILN_JOB_OPTION_H
#define KILN_JOB_OPTION_H

#include "base/arena.h"
#include "base/report.h"
#include "base/text.h"

typedef struct option_row option_row;

/* How a value is read and printed; what is printed is read back as the same value. */
typedef struct option_kind {
    bool (*parse)(const option_row *, const char *text, void *field, kiln_arena *); /* false: not in the domain */
    void (*print)(const option_row *, const void *field, kiln_text *);
    bool is_switch;   /* takes no argument on a command line, where its presence means true */
    bool repeats;     /* each use adds a value */
} option_kind;

typedef struct option_choice {
    const char *name;
    int value;
} option_choice;

struct option_row {
    const char *name;     /* "env-rotate": --env-rotate, "env-rotate" in JSON */
    char letter;          /* 'o': -o; 0: none */
    const char *argument; /* "DEG"; NULL: a switch */
    const char *group;    /* heading in --help */
    const char *help;     /* one line, without the default */
    const char *fallback; /* the default, as text that parses; NULL: the field stays zero */
    const char *shown;    /* what --help calls the default where that is more than the text; NULL: fallback */
    const char *domain;   /* what the value must be, after 'is not': "a number of degrees" */
    const option_kind *kind;
    const option_choice *choices; /* of option_choices; ends with a NULL name */
    double low, high;     /* of numbers and counts */
    size_t offset;        /* of the field */
    unsigned also;        /* bits of those who take the option beside the commands that the table is for */
    unsigned except;      /* bits of those commands that do not take it all the same */
    void (*explain)(const char *text, kiln_text *remedy); /* what is wrong with a text that parse refused; NULL */
};

typedef struct option_table {
    const option_row *rows;
    size_t count; /* at most 64 */
} option_table;

extern const option_kind option_text, option_texts, option_count, option_integer, option_number, option_toggle,
    option_choices;

/* A list of texts, for options that repeat. */
typedef struct option_list {
    const char **items;
    uint32_t count;
} option_list;

/* Sets a field; where names the option or the place in a file. *given gets the row's bit. */
bool option_set(const option_table *, const option_row *, const char *text, void *fields, uint64_t *given,
                kiln_arena *, const kiln_where *where, kiln_report *);
/* Sets all fields to their defaults. False: out of memory. */
bool option_defaults(const option_table *, void *fields, kiln_arena *);
/* NULL: no such row. */
const option_row *option_find(const option_table *, const char *name);
/* The text of a field's value: of a list, of its item number `index`. */
void option_print(const option_row *, const void *fields, uint32_t index, kiln_text *);
/* Whether the row of the field at this offset was set. */
bool option_given(const option_table *, uint64_t given, size_t offset);
/* "kiln render car.glb --size 64x64": appends the options that were given, quoted for a shell where they must be. */
void option_print_command(const option_table *, const void *fields, uint64_t given, kiln_text *);
/* Appends one word, in single quotes where a shell needs them. */
void option_quote(const char *word, kiln_text *);

/* Shortest text that text_to_double reads back as the same value. */
void option_print_number(double value, kiln_text *);

#endif
