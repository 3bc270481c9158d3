#include "color/embedded.hpp"

#include "color/gamut.h"
#include "color/names.h"

namespace OCIO = OCIO_NAMESPACE;

namespace {

/* Scene-referred spaces are defined against ACES2065-1, display-referred ones against CIE XYZ of a D65 white; Bradford
 * adapts between the whites. Space and view names are those of OpenColorIO's own ACES configs where they have one, so
 * that command lines go over to a studio's config. */
const char *const kXyz = "CIE-XYZ-D65";
const char *const kRaw = "Raw";
const char *const kPlainView = "Un-tone-mapped";
const char *const kAcesView = "ACES 1.0 - SDR Video";

OCIO::TransformRcPtr builtin(const char *style, OCIO::TransformDirection direction = OCIO::TRANSFORM_DIR_FORWARD) {
    OCIO::BuiltinTransformRcPtr t = OCIO::BuiltinTransform::Create();
    t->setStyle(style);
    t->setDirection(direction);
    return t;
}

OCIO::TransformRcPtr aces_to_xyz() { return builtin("UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD"); }

/* XYZ of a D65 white to linear RGB of a gamut that has this white. */
OCIO::TransformRcPtr xyz_to_linear(const color_gamut &gamut) {
    double m[9];
    gamut_to_xyz(&gamut, m);
    const double m44[16] = {m[0], m[1], m[2], 0, m[3], m[4], m[5], 0, m[6], m[7], m[8], 0, 0, 0, 0, 1};
    OCIO::MatrixTransformRcPtr t = OCIO::MatrixTransform::Create();
    t->setMatrix(m44);
    t->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
    return t;
}

/* IEC 61966-2-1: linear to encoded; continued below 0 by symmetry, as OpenColorIO's own sRGB display is. */
OCIO::TransformRcPtr srgb_curve(OCIO::NegativeStyle negatives) {
    OCIO::ExponentWithLinearTransformRcPtr t = OCIO::ExponentWithLinearTransform::Create();
    t->setGamma({2.4, 2.4, 2.4, 1.0});
    t->setOffset({0.055, 0.055, 0.055, 0.0});
    t->setNegativeStyle(negatives);
    t->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
    return t;
}

OCIO::GroupTransformRcPtr group(std::initializer_list<OCIO::TransformRcPtr> transforms) {
    OCIO::GroupTransformRcPtr t = OCIO::GroupTransform::Create();
    for (const auto &part : transforms) t->appendTransform(part);
    return t;
}

OCIO::ColorSpaceRcPtr space(OCIO::ReferenceSpaceType reference, const char *name, const char *encoding,
                            std::initializer_list<const char *> aliases) {
    OCIO::ColorSpaceRcPtr s = OCIO::ColorSpace::Create(reference);
    s->setName(name);
    s->setEncoding(encoding);
    s->setBitDepth(OCIO::BIT_DEPTH_F32);
    for (const char *alias : aliases) s->addAlias(alias);
    return s;
}

OCIO::ColorSpaceRcPtr scene_space(const char *name, const char *encoding,
                                  std::initializer_list<const char *> aliases) {
    return space(OCIO::REFERENCE_SPACE_SCENE, name, encoding, aliases);
}

void add_scene_spaces(const OCIO::ConfigRcPtr &config) {
    config->addColorSpace(scene_space(COLOR_ACES, "scene-linear", {"aces2065_1", "lin_ap0", "ACES - ACES2065-1"}));

    OCIO::ColorSpaceRcPtr acescg = scene_space("ACEScg", "scene-linear", {"lin_ap1", "ACES - ACEScg"});
    acescg->setTransform(builtin("ACEScg_to_ACES2065-1"), OCIO::COLORSPACE_DIR_TO_REFERENCE);
    config->addColorSpace(acescg);

    const struct {
        const char *name;
        std::initializer_list<const char *> aliases;
    } linear[] = {
        {COLOR_LIN_REC709, {"Linear Rec.709 (sRGB)", "Linear Rec.709", "lin_srgb", "lin_rec709_srgb",
                            "Utility - Linear - Rec.709", "Utility - Linear - sRGB"}},
        {"lin_p3d65", {"Linear P3-D65", "lin_displayp3", "Utility - Linear - P3-D65"}},
        {"lin_rec2020", {"Linear Rec.2020", "Utility - Linear - Rec.2020"}},
    };
    for (const auto &row : linear) {
        OCIO::ColorSpaceRcPtr s = scene_space(row.name, "scene-linear", row.aliases);
        s->setTransform(group({aces_to_xyz(), xyz_to_linear(*gamut_find(row.name))}),
                        OCIO::COLORSPACE_DIR_FROM_REFERENCE);
        config->addColorSpace(s);
    }

    OCIO::ColorSpaceRcPtr texture =
        scene_space(COLOR_SRGB_TEXTURE, "sdr-video", {"srgb_tx", "srgb_texture", "Utility - sRGB - Texture"});
    texture->setTransform(group({aces_to_xyz(), xyz_to_linear(*gamut_find(COLOR_LIN_REC709)),
                                 srgb_curve(OCIO::NEGATIVE_LINEAR)}),
                          OCIO::COLORSPACE_DIR_FROM_REFERENCE);
    config->addColorSpace(texture);

    OCIO::ColorSpaceRcPtr raw = scene_space(kRaw, "data", {"Utility - Raw"});
    raw->setIsData(true);
    config->addColorSpace(raw);
}

void add_view_transforms(const OCIO::ConfigRcPtr &config) {
    /* Neutral's curve is applied in front of the processor (color/neutral.h): here it is plain. */
    const struct {
        const char *name;
        OCIO::TransformRcPtr transform;
    } rows[] = {
        {kPlainView, aces_to_xyz()},
        {COLOR_VIEW_NEUTRAL, aces_to_xyz()},
        {kAcesView, builtin("ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0")},
    };
    for (const auto &row : rows) {
        OCIO::ViewTransformRcPtr v = OCIO::ViewTransform::Create(OCIO::REFERENCE_SPACE_SCENE);
        v->setName(row.name);
        v->setTransform(row.transform, OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE);
        config->addViewTransform(v);
    }
    config->setDefaultViewTransformName(kPlainView);
}

void add_display(const OCIO::ConfigRcPtr &config, const char *display, const char *space_name, const char *alias,
                 const OCIO::TransformRcPtr &from_xyz) {
    OCIO::ColorSpaceRcPtr s = space(OCIO::REFERENCE_SPACE_DISPLAY, space_name, "sdr-video", {alias});
    s->setTransform(from_xyz, OCIO::COLORSPACE_DIR_FROM_REFERENCE);
    config->addColorSpace(s);
    for (const char *view : {COLOR_VIEW_NEUTRAL, kAcesView, kPlainView})
        config->addDisplayView(display, view, view, space_name, "", "", "");
    config->addDisplayView(display, kRaw, kRaw, "");
}

void add_displays(const OCIO::ConfigRcPtr &config) {
    config->addColorSpace(space(OCIO::REFERENCE_SPACE_DISPLAY, kXyz, "display-linear", {"cie_xyz_d65"}));
    add_display(config, "sRGB", "sRGB - Display", "srgb_display", builtin("DISPLAY - CIE-XYZ-D65_to_sRGB"));
    add_display(config, "Rec.1886", "Rec.1886 Rec.709 - Display", "rec1886_rec709_display",
                builtin("DISPLAY - CIE-XYZ-D65_to_REC.1886-REC.709"));
    /* OpenColorIO has a built-in Display P3 from 2.2 on only. */
    add_display(config, "Display P3", "Display P3 - Display", "displayp3_display",
                group({xyz_to_linear(*gamut_find("lin_p3d65")), srgb_curve(OCIO::NEGATIVE_MIRROR)}));
}

} // namespace

OCIO::ConstConfigRcPtr make_embedded_config() {
    OCIO::ConfigRcPtr config = OCIO::Config::Create();
    config->setVersion(2, 1);
    config->setName("kiln");
    config->setDescription("Embedded in kiln; see docs/color.md.");
    add_scene_spaces(config);
    add_view_transforms(config);
    add_displays(config);

    const struct {
        const char *role, *space;
    } roles[] = {
        {COLOR_INTERCHANGE, COLOR_ACES}, {"cie_xyz_d65_interchange", kXyz}, {"scene_linear", COLOR_LIN_REC709},
        {"rendering", COLOR_LIN_REC709}, {"color_timing", COLOR_LIN_REC709}, {"compositing_linear", COLOR_LIN_REC709},
        {"color_picking", COLOR_SRGB_TEXTURE}, {"texture_paint", COLOR_SRGB_TEXTURE},
        {"matte_paint", COLOR_SRGB_TEXTURE}, {"data", kRaw}, {"default", COLOR_LIN_REC709},
    };
    for (const auto &row : roles) config->setRole(row.role, row.space);
    return config;
}
