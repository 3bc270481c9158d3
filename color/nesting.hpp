/* color/nesting.hpp: whether the definitions of a config come to an end. */
#ifndef KILN_COLOR_NESTING_HPP
#define KILN_COLOR_NESTING_HPP

#include <OpenColorIO/OpenColorIO.h>

/* Throws when a colour space, look, view or named transform is defined by itself or through very many others:
 * OpenColorIO 2.1 follows such definitions until the stack ends. */
void check_nesting(const OCIO_NAMESPACE::ConstConfigRcPtr &config);

#endif
