/* job/layers.h: what --aov asks for. */
#ifndef KILN_JOB_LAYERS_H
#define KILN_JOB_LAYERS_H

#include "job/option.h"
#include "kiln/film.h"
#include "kiln/scene.h"

typedef struct job_layers {
    uint32_t aovs;    /* bits 1 << kiln_aov */
    uint32_t mattes;  /* bits 1 << kiln_matte */
    uint32_t lobes;   /* bits 1 << kiln_lobe, of lobe:NAME */
    bool emission, direct, indirect;
    bool every_light; /* lightgroup:* */
    option_list lights; /* names of lightgroup:NAME */
} job_layers;

extern const option_kind option_layers;

bool layers_any(const job_layers *);

/* Names for kiln_film_desc.parts, in one piece; free(). False: reported: a light that the scene does not have. */
bool layers_parts(const job_layers *, const kiln_scene *, const char *const **parts, uint32_t *count, kiln_report *);

/* What a layer of a file is called; the channels follow a point. */
void layers_name_part(const kiln_film_part_info *, kiln_text *);

/* What the layers of a matte are called, but for their number. */
const char *layers_name_matte(kiln_matte);

/* Of all that was asked for: each ends with a 0, and the last is followed by another. */
void layers_list(const job_layers *, const kiln_film *, kiln_text *);

#endif
