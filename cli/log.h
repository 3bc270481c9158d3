/* cli/log.h: lines on standard error. */
#ifndef KILN_CLI_LOG_H
#define KILN_CLI_LOG_H

#include "cli/cli.h"

typedef enum log_level { LOG_ERRORS, LOG_NORMAL, LOG_VERBOSE } log_level;
void log_set_level(log_level);

void log_line(log_level, const char *format, ...) KILN_PRINTF(2, 3);

/* Messages that were not printed yet: warnings and notes from LOG_NORMAL on. */
void log_flush(const kiln_report *);
/* At the end: the messages again that came more often since they were printed, and the number of warnings. */
void log_warning_counts(const kiln_report *);

/* The progress line is taken off before anything is printed, and drawn again by the next call. */
void log_progress(cli_progress, const kiln_progress *);
void log_progress_end(void);

#endif
