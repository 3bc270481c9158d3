/* render/predict.h: how long a render will take, and how noisy it will be, from its first samples. */
#ifndef KILN_RENDER_PREDICT_H
#define KILN_RENDER_PREDICT_H

#include "kiln/render.h"

/* What the first samples have shown. */
typedef struct predict_pilot {
    uint32_t spp;    /* in every pixel */
    double seconds;  /* that they took */
    double error;    /* √relMSE, as estimated */
    double gain;     /* of relMSE, by samples that go where they are needed: 1 where they do not */
} predict_pilot;

/* The error falls with the root of the samples, and they go on to take as long as they did. spp_limit: the rule, or what
 * a film can hold. */
kiln_prediction predict(const predict_pilot *, const kiln_render_options *, uint32_t spp_limit);

#endif
