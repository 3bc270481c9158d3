/* job/stats.h: everything that a run knows about itself. */
#ifndef KILN_JOB_STATS_H
#define KILN_JOB_STATS_H

#include "job/json.h"
#include "job/run.h"

json_t *stats_make(const job_run *);

/* Parts that other reports share. */
json_t *stats_versions(void);
json_t *stats_machine(uint32_t threads); /* 0: all */
json_t *stats_camera(const job_view *);
json_t *stats_bounds(kiln_bounds);
json_t *stats_options(const job_options *); /* that were given */
json_t *stats_phases(const job_run *);
json_t *stats_memory(const job_run *);
json_t *stats_stages(const kiln_render_stats *); /* those that took time */
json_t *stats_messages(const kiln_report *, kiln_severity);

#endif
