/* color/embedded.hpp: the config that kiln brings along, built from OpenColorIO's own transforms. */
#ifndef KILN_COLOR_EMBEDDED_HPP
#define KILN_COLOR_EMBEDDED_HPP

#include <OpenColorIO/OpenColorIO.h>

/* Throws what OpenColorIO throws. */
OCIO_NAMESPACE::ConstConfigRcPtr make_embedded_config();

#endif
