/* job/metadata.h: what the files of a run say about themselves. */
#ifndef KILN_JOB_METADATA_H
#define KILN_JOB_METADATA_H

#include "job/run.h"

typedef struct job_metadata {
    kiln_arena arena;
    const char *text[8]; /* pairs for display-referred files; the same for the same picture, whenever it is made */
    uint32_t text_count;
    kiln_exr_attribute attributes[24];
    uint32_t attribute_count;
} job_metadata;

bool metadata_make(job_metadata *, const job_run *); /* false: out of memory */
void metadata_free(job_metadata *);

/* "kiln render car.glb --size 64x64"; free(). NULL: out of memory. */
char *metadata_command(const job_run *);

#endif
