/* render/film/bounce.h: how far light had come when the camera saw it. */
#ifndef KILN_RENDER_FILM_BOUNCE_H
#define KILN_RENDER_FILM_BOUNCE_H

typedef enum path_bounce { BOUNCE_EMISSION, BOUNCE_DIRECT, BOUNCE_INDIRECT, PATH_BOUNCES } path_bounce;

#endif
