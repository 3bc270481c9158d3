/* job/study_math.h: what repeated measurements tell: means with intervals, slopes, and who is beaten by nobody. */
#ifndef KILN_JOB_STUDY_MATH_H
#define KILN_JOB_STUDY_MATH_H

#include <stdbool.h>
#include <stddef.h>

/* A mean and its 95 % interval; NAN where there are too few values. */
typedef struct study_range {
    double mean, low, high;
} study_range;

/* Student's t that 97.5 % are below; freedom ≥ 1. */
double study_student(size_t freedom);

/* Of the values that are finite, by Student's distribution. */
study_range study_interval(const double *values, size_t count);
/* The same for their logarithms, taken back: a geometric mean. All NAN when a value is not above 0. */
study_range study_interval_of_logs(const double *values, size_t count);
/* Slope of the line through points (log x, log y), least squares. All NAN without three points of positive coordinates
 * and two different x. */
study_range study_slope_of_logs(const double *x, const double *y, size_t count);

/* front[i]: no other point has both less time and less error, nor equals it in one and is less in the other. Points
 * that are not finite are beaten. */
void study_front(const double *time, const double *error, size_t count, bool *front);

#endif
