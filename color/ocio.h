/* color/ocio.h: the seam over OpenColorIO, whose headers only the C++ files of this folder include. Nothing that it
 * throws crosses: failures become messages in the report. Everything is immutable, so that any thread may use it. */
#ifndef KILN_COLOR_OCIO_H
#define KILN_COLOR_OCIO_H

#include "base/report.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ocio_config ocio_config;
typedef struct ocio_processor ocio_processor;

/* A file, an archive, or "ocio://…" where the library knows it. NULL: reported. */
ocio_config *ocio_config_read(const char *path, const kiln_where *, kiln_report *);
/* The config that color/embedded.cpp builds. NULL: reported. */
ocio_config *ocio_config_embedded(kiln_report *);
void ocio_config_free(ocio_config *);

/* "2.1.2" */
const char *ocio_version(void);
/* The library reads profiles up to its own version. */
bool ocio_version_too_new(unsigned major, unsigned minor);

/* Names, borrowed from the config until the next call; NULL behind the last. display: for views alone. */
typedef enum ocio_kind { OCIO_DISPLAYS, OCIO_VIEWS, OCIO_LOOKS, OCIO_SPACES } ocio_kind;
const char *ocio_config_name(const ocio_config *, ocio_kind, const char *display, size_t index);
const char *ocio_config_title(const ocio_config *);                                /* what the file calls itself; "" */
const char *ocio_config_default_display(const ocio_config *);                      /* NULL: no display at all */
const char *ocio_config_default_view(const ocio_config *, const char *display);    /* NULL: no view at all */
/* The space that pixels of a view are in; NULL: unknown. */
const char *ocio_config_view_space(const ocio_config *, const char *display, const char *view);

/* The colour space that has this name, alias or role; NULL: none. */
const char *ocio_config_find(const ocio_config *, const char *name);
bool ocio_config_has_role(const ocio_config *, const char *role);
typedef enum ocio_reference { OCIO_SCENE_REFERRED, OCIO_DISPLAY_REFERRED, OCIO_DATA } ocio_reference;
ocio_reference ocio_config_reference(const ocio_config *, const char *space);
bool ocio_config_says_linear(const ocio_config *, const char *space); /* its encoding is "scene-linear" */

/* From one colour space to another; NULL: reported. */
ocio_processor *ocio_convert(const ocio_config *, const char *from, const char *to, const kiln_where *, kiln_report *);
/* From a colour space to a display; looks NULL: the view's own, "": none. NULL: reported. */
ocio_processor *ocio_show(const ocio_config *, const char *from, const char *display, const char *view,
                          const char *looks, const kiln_where *, kiln_report *);
void ocio_processor_free(ocio_processor *);

/* In place. Pixels that the library fails on become black. */
void ocio_apply(const ocio_processor *, float *rgb, size_t pixel_count);

#ifdef __cplusplus
}
#endif
#endif
