/* job/template.h: names of output files with places to fill in. */
#ifndef KILN_JOB_TEMPLATE_H
#define KILN_JOB_TEMPLATE_H

#include "base/report.h"
#include "base/text.h"

typedef struct template_values {
    const char *name;    /* {name}: the asset's, without folder and suffix */
    const char *camera;  /* {camera} */
    const char *variant; /* {variant} */
    int64_t frame;       /* {frame}, {frame:4}, #### (two or more) */
} template_values;

/* "{{" and "}}" stand for braces. What is filled in cannot leave the folder: its slashes and control characters become
 * '_'. False: reported; `where` names the option. */
bool template_expand(const char *pattern, const template_values *, kiln_text *out, const kiln_where *where,
                     kiln_report *);

/* "dir/car.final.glb" gives "car.final"; "-" gives "stdin"; free(). */
char *template_asset_name(const char *path);

#endif
