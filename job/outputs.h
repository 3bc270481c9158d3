/* job/outputs.h: which files a job writes. Everything that can go wrong is found before the render starts. */
#ifndef KILN_JOB_OUTPUTS_H
#define KILN_JOB_OUTPUTS_H

#include "base/file.h"
#include "job/options.h"
#include "job/template.h"

typedef enum output_kind { OUTPUT_UNKNOWN, OUTPUT_DISPLAY, OUTPUT_EXR, OUTPUT_HDR } output_kind;

typedef struct output {
    char *path;
    output_kind kind;
    bool written;
} output;

typedef struct output_plan {
    output *items;
    uint32_t count;
} output_plan;

/* By suffix; "-" is a display-referred picture. */
output_kind output_kind_of(const char *path);
/* As messages call it: "PNG". */
const char *output_format_name(const char *path);

/* Fills in the templates and checks what the names alone tell. */
bool outputs_plan(const job_options *, const template_values *, output_plan *, kiln_report *);
void outputs_free(output_plan *);
bool outputs_any(const output_plan *, output_kind);

/* No two of the outputs and the statistics (NULL: none) are one file under two names. */
bool outputs_check_distinct(const output_plan *, const char *stats, kiln_report *);

/* None of them is this file that the job reads. reader completes a message: "a file that the asset consists of". */
bool outputs_check_input(const output_plan *, const char *stats, file_identity input, const char *reader,
                         kiln_report *);

/* Tries whether every file, and the one for statistics, can be written. Leaves nothing behind. */
bool outputs_try(const output_plan *, const char *stats, kiln_report *);

#endif
