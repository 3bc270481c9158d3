/* color/names.h: names in configs that the code refers to. */
#ifndef KILN_COLOR_NAMES_H
#define KILN_COLOR_NAMES_H

/* In the embedded config. */
#define COLOR_LIN_REC709 "lin_rec709"
#define COLOR_SRGB_TEXTURE "sRGB - Texture"
#define COLOR_ACES "ACES2065-1"
#define COLOR_VIEW_NEUTRAL "Khronos PBR Neutral"

/* The role by which a config names its ACES2065-1. */
#define COLOR_INTERCHANGE "aces_interchange"

#endif
