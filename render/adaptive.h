/* render/adaptive.h: which pixels the next samples go to.
 *
 * The error that is reported is the mean over pixels of e_i/n_i, where e_i is what one sample's relative variance would
 * be. For a given number of samples it is least when n_i goes with √e_i (Neyman 1934; Lagrange's multiplier). What one
 * pixel's two replicates say of e_i is next to nothing, so its neighbourhood is asked; that also keeps apart what a pixel
 * gets from what it has found, which would be a bias: a pixel that has been lucky would stay so. Decided from the film's
 * integers, in a fixed order: the same for any number of threads. */
#ifndef KILN_RENDER_ADAPTIVE_H
#define KILN_RENDER_ADAPTIVE_H

#include "render/film/film.h"

/* Fewer samples in each pixel are not evidence enough to spend others by. */
enum { ADAPTIVE_SPP_MIN = 16 };

/* Sets targets, one for each pixel, none below what it has, so that the film will have `samples` in all, but for a
 * block or so. scale: what the picture is multiplied by before it is judged. False: out of memory. */
bool adaptive_plan(const kiln_film *, double scale, uint64_t samples, uint32_t *targets);

/* By what relMSE at as many samples would be multiplied if all of them went where they are needed most: (mean √e)² over
 * mean e, at most 1. 1 when memory is exhausted. */
double adaptive_gain(const kiln_film *, double scale);

#endif
