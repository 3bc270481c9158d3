/* job/compare.h: kiln color: pictures against each other, and pictures as they are shown. */
#ifndef KILN_JOB_COMPARE_H
#define KILN_JOB_COMPARE_H

#include "job/json.h"
#include "job/options.h"

/* The comparison as JSON; true unless an error was added, a difference above the threshold among them. */
bool compare_files(const job_options *, const char *file, const char *reference, json_t **json, kiln_report *);

/* A map of errors as a file: floats as they are, else in false colours up to `end`. */
bool compare_write_map(const char *path, const float *map, uint32_t width, uint32_t height, float end, kiln_report *);

bool convert_file(const job_options *, const char *file, kiln_report *);

#endif
