#include "color/ocio.h"

#include <algorithm>
#include <new>
#include <string>

#include "color/embedded.hpp"
#include "color/nesting.hpp"

namespace OCIO = OCIO_NAMESPACE;

struct ocio_config {
    OCIO::ConstConfigRcPtr config;
};

struct ocio_processor {
    OCIO::ConstCPUProcessorRcPtr processor;
};

namespace {

/* OpenColorIO's messages run over several lines. */
std::string one_line(const char *text) {
    std::string line(text);
    std::replace(line.begin(), line.end(), '\n', ' ');
    std::replace(line.begin(), line.end(), '\t', ' ');
    const size_t end = line.find_last_not_of(' ');
    return line.substr(0, end == std::string::npos ? 0 : end + 1);
}

/* What make() returns, or NULL with an error of this code. */
template <class Make>
auto guard(kiln_code code, const char *remedy, const kiln_where *where, kiln_report *report, Make make)
    -> decltype(make()) {
    try {
        return make();
    } catch (const OCIO::ExceptionMissingFile &e) {
        report_error(report, KILN_CODE_COLOR_CONFIG, where,
                     "put the file where the config looks for it: search_path is relative to the config's folder",
                     "%s", one_line(e.what()).c_str());
    } catch (const std::bad_alloc &) {
        report_no_memory(report, "reading a colour config");
    } catch (const std::exception &e) {
        report_error(report, code, where, remedy, "%s", one_line(e.what()).c_str());
    } catch (...) {
        report_error(report, KILN_CODE_INTERNAL, where, NULL, "OpenColorIO failed without saying why");
    }
    return nullptr;
}

/* For questions that have 'nothing' as an answer. */
template <class Ask> auto ask(Ask question) -> decltype(question()) {
    try {
        return question();
    } catch (...) {
        return {};
    }
}

const char *none_if_empty(const char *text) { return text && *text ? text : nullptr; }

/* pow and log in full: the faster ones, which newer releases of OpenColorIO prefer, are off by up to 1e-4, six codes of
 * 16 bits. */
ocio_processor *make_processor(const OCIO::ConstConfigRcPtr &config, const OCIO::ConstTransformRcPtr &transform) {
    OCIO::ConstProcessorRcPtr processor = config->getProcessor(transform);
    return new ocio_processor{processor->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS)};
}

} // namespace

ocio_config *ocio_config_read(const char *path, const kiln_where *where, kiln_report *report) {
    return guard(KILN_CODE_COLOR_CONFIG, "repair the file, or name another config with --ocio or $OCIO", where, report,
                 [&] {
                     const OCIO::ConstConfigRcPtr config = OCIO::Config::CreateFromFile(path);
                     check_nesting(config);
                     return new ocio_config{config};
                 });
}

ocio_config *ocio_config_embedded(kiln_report *report) {
    return guard(KILN_CODE_INTERNAL, NULL, NULL, report, [] { return new ocio_config{make_embedded_config()}; });
}

void ocio_config_free(ocio_config *config) { delete config; }

const char *ocio_version(void) { return OCIO::GetVersion(); }

bool ocio_version_too_new(unsigned major, unsigned minor) {
    const unsigned version = static_cast<unsigned>(OCIO::GetVersionHex());
    return (major << 8 | std::min(minor, 255u)) > version >> 16;
}

const char *ocio_config_name(const ocio_config *c, ocio_kind kind, const char *display, size_t index) {
    return ask([&]() -> const char * {
        const OCIO::Config &config = *c->config;
        if (index > 1u << 20) return nullptr;
        const int i = static_cast<int>(index);
        switch (kind) {
        case OCIO_DISPLAYS: return i < config.getNumDisplays() ? config.getDisplay(i) : nullptr;
        case OCIO_VIEWS: return i < config.getNumViews(display) ? config.getView(display, i) : nullptr;
        case OCIO_LOOKS: return i < config.getNumLooks() ? config.getLookNameByIndex(i) : nullptr;
        case OCIO_SPACES: return i < config.getNumColorSpaces() ? config.getColorSpaceNameByIndex(i) : nullptr;
        }
        return nullptr;
    });
}

const char *ocio_config_title(const ocio_config *c) { return c->config->getName(); }

const char *ocio_config_default_display(const ocio_config *c) {
    return ask([&] { return none_if_empty(c->config->getDefaultDisplay()); });
}

const char *ocio_config_default_view(const ocio_config *c, const char *display) {
    return ask([&] { return none_if_empty(c->config->getDefaultView(display)); });
}

const char *ocio_config_view_space(const ocio_config *c, const char *display, const char *view) {
    return ask([&]() -> const char * {
        const char *space = none_if_empty(c->config->getDisplayViewColorSpaceName(display, view));
        /* A shared view may leave the space to the display, which then names it. */
        const bool by_display = space && std::string(space) == OCIO::OCIO_VIEW_USE_DISPLAY_NAME;
        return by_display ? display : space;
    });
}

const char *ocio_config_find(const ocio_config *c, const char *name) {
    return ask([&]() -> const char * {
        OCIO::ConstColorSpaceRcPtr space = c->config->getColorSpace(name);
        return space ? space->getName() : nullptr;
    });
}

bool ocio_config_has_role(const ocio_config *c, const char *role) {
    return ask([&] { return c->config->hasRole(role); });
}

ocio_reference ocio_config_reference(const ocio_config *c, const char *name) {
    return ask([&] {
        OCIO::ConstColorSpaceRcPtr space = c->config->getColorSpace(name);
        if (space && space->isData()) return OCIO_DATA;
        const bool display = space && space->getReferenceSpaceType() == OCIO::REFERENCE_SPACE_DISPLAY;
        return display ? OCIO_DISPLAY_REFERRED : OCIO_SCENE_REFERRED;
    });
}

bool ocio_config_says_linear(const ocio_config *c, const char *name) {
    return ask([&] {
        OCIO::ConstColorSpaceRcPtr space = c->config->getColorSpace(name);
        return space && std::string(space->getEncoding()) == "scene-linear";
    });
}

ocio_processor *ocio_convert(const ocio_config *c, const char *from, const char *to, const kiln_where *where,
                             kiln_report *report) {
    return guard(KILN_CODE_COLOR_CONFIG, "repair the config", where, report, [&] {
        OCIO::ColorSpaceTransformRcPtr t = OCIO::ColorSpaceTransform::Create();
        t->setSrc(from);
        t->setDst(to);
        return make_processor(c->config, t);
    });
}

ocio_processor *ocio_show(const ocio_config *c, const char *from, const char *display, const char *view,
                          const char *looks, const kiln_where *where, kiln_report *report) {
    return guard(KILN_CODE_COLOR_CONFIG, "repair the config", where, report, [&] {
        OCIO::GroupTransformRcPtr t = OCIO::GroupTransform::Create();
        if (looks && *looks) {
            OCIO::LookTransformRcPtr look = OCIO::LookTransform::Create();
            look->setSrc(from);
            look->setDst(from);
            look->setLooks(looks);
            t->appendTransform(look);
        }
        OCIO::DisplayViewTransformRcPtr show = OCIO::DisplayViewTransform::Create();
        show->setSrc(from);
        show->setDisplay(display);
        show->setView(view);
        show->setLooksBypass(looks != nullptr);
        t->appendTransform(show);
        return make_processor(c->config, t);
    });
}

void ocio_processor_free(ocio_processor *processor) { delete processor; }

void ocio_apply(const ocio_processor *p, float *rgb, size_t pixel_count) {
    try {
        OCIO::PackedImageDesc image(rgb, static_cast<long>(pixel_count), 1, 3);
        p->processor->apply(image);
    } catch (...) {
        std::fill(rgb, rgb + 3 * pixel_count, 0.0f);
    }
}
