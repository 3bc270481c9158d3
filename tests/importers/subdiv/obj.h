/* tests/importers/subdiv/obj.h: OpenSubdiv's regression shapes: OBJ with tags ("t crease 2/1/0 0 1 2.0"). */
#ifndef KILN_TESTS_SUBDIV_OBJ_H
#define KILN_TESTS_SUBDIV_OBJ_H

#include "tests/importers/subdiv/shapes.h"

/* Reads path; the scheme is the beginning of the file's name (catmark_, loop_, bilinear_). False: no such file. */
bool obj_read(const char *path, shape *);

#endif
