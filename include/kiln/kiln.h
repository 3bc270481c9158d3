/* kiln/kiln.h: everything. docs/conventions.md states the rules of ownership, errors and units. */
#ifndef KILN_KILN_H
#define KILN_KILN_H

#include "kiln/api.h"
#include "kiln/color.h"
#include "kiln/compare.h"
#include "kiln/difference.h"
#include "kiln/effects.h"
#include "kiln/film.h"
#include "kiln/image.h"
#include "kiln/import.h"
#include "kiln/job.h"
#include "kiln/material.h"
#include "kiln/mesh.h"
#include "kiln/render.h"
#include "kiln/report.h"
#include "kiln/scene.h"

#endif
