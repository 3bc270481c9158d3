/* job/info.h: what the machine, the libraries and the colour config offer. */
#ifndef KILN_JOB_INFO_H
#define KILN_JOB_INFO_H

#include "job/json.h"
#include "job/options.h"

/* NULL: an error was added. */
json_t *info_make(const job_options *, kiln_report *);

#endif
