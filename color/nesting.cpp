#include "color/nesting.hpp"

#include <algorithm>
#include <map>
#include <string>

namespace OCIO = OCIO_NAMESPACE;

namespace {

/* Real configs define a space through two or three others; each costs OpenColorIO some kilobytes of stack. */
const int kDeepest = 64;
const int kOpen = -1;

class Walk {
public:
    explicit Walk(const OCIO::ConstConfigRcPtr &config) : config_(config), context_(config->getCurrentContext()) {}

    int space(const char *given) {
        const std::string name = context_->resolveStringVar(given);
        const OCIO::ConstColorSpaceRcPtr s = config_->getColorSpace(name.c_str());
        const OCIO::ConstNamedTransformRcPtr n = config_->getNamedTransform(name.c_str());
        if (s)
            return node("colour space", s->getName(), s->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE),
                        s->getTransform(OCIO::COLORSPACE_DIR_FROM_REFERENCE), nullptr);
        if (n)
            return node("named transform", n->getName(), n->getTransform(OCIO::TRANSFORM_DIR_FORWARD),
                        n->getTransform(OCIO::TRANSFORM_DIR_INVERSE), nullptr);
        return 0;
    }

    int look(const char *name) {
        const OCIO::ConstLookRcPtr l = config_->getLook(name);
        return l ? node("look", l->getName(), l->getTransform(), l->getInverseTransform(), l->getProcessSpace()) : 0;
    }

    int view_transform(const char *name) {
        const OCIO::ConstViewTransformRcPtr v = config_->getViewTransform(name);
        return v ? node("view transform", v->getName(), v->getTransform(OCIO::VIEWTRANSFORM_DIR_TO_REFERENCE),
                        v->getTransform(OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE), nullptr)
                 : 0;
    }

private:
    /* How many definitions lie under this one, itself included. */
    int node(const char *kind, const std::string &name, const OCIO::ConstTransformRcPtr &one,
             const OCIO::ConstTransformRcPtr &other, const char *process_space) {
        const auto slot = heights_.emplace(std::string(kind) + " \"" + name + "\"", kOpen);
        int &height = slot.first->second;
        if (!slot.second && height != kOpen) return height;
        if (!slot.second || depth_ >= kDeepest) fail(slot.first->first);
        depth_++;
        const int below = std::max({transform(one), transform(other), process_space ? space(process_space) : 0});
        depth_--;
        if (below >= kDeepest) fail(slot.first->first);
        return height = below + 1;
    }

    [[noreturn]] static void fail(const std::string &what) {
        throw OCIO::Exception((what + " is defined by itself, or through too many others").c_str());
    }

    int transform(const OCIO::ConstTransformRcPtr &t) {
        if (const auto group = std::dynamic_pointer_cast<const OCIO::GroupTransform>(t)) {
            int height = 0;
            for (int i = 0; i < group->getNumTransforms(); i++)
                height = std::max(height, transform(group->getTransform(i)));
            return height;
        }
        if (const auto convert = std::dynamic_pointer_cast<const OCIO::ColorSpaceTransform>(t))
            return std::max(space(convert->getSrc()), space(convert->getDst()));
        if (const auto grade = std::dynamic_pointer_cast<const OCIO::LookTransform>(t))
            return std::max({space(grade->getSrc()), space(grade->getDst()), looks(grade->getLooks())});
        if (const auto show = std::dynamic_pointer_cast<const OCIO::DisplayViewTransform>(t)) {
            const char *display = show->getDisplay(), *view = show->getView();
            return std::max({space(show->getSrc()), space(config_->getDisplayViewColorSpaceName(display, view)),
                             looks(config_->getDisplayViewLooks(display, view)),
                             view_transform(config_->getDisplayViewTransformName(display, view))});
        }
        return 0;
    }

    /* "a, -b | c" */
    int looks(const char *given) {
        const std::string list = context_->resolveStringVar(given);
        int height = 0;
        for (size_t at = 0; at < list.size();) {
            const size_t end = std::min(list.find_first_of(",:|", at), list.size());
            const size_t first = std::min(list.find_first_not_of(" +-", at), end);
            const size_t last = list.find_last_not_of(' ', end - 1);
            if (first < end) height = std::max(height, look(list.substr(first, last + 1 - first).c_str()));
            at = end + 1;
        }
        return height;
    }

    OCIO::ConstConfigRcPtr config_;
    OCIO::ConstContextRcPtr context_;
    std::map<std::string, int> heights_;
    int depth_ = 0;
};

} // namespace

void check_nesting(const OCIO::ConstConfigRcPtr &config) {
    Walk walk(config);
    const auto all = OCIO::SEARCH_REFERENCE_SPACE_ALL;
    for (int i = 0; i < config->getNumColorSpaces(all, OCIO::COLORSPACE_ALL); i++)
        walk.space(config->getColorSpaceNameByIndex(all, OCIO::COLORSPACE_ALL, i));
    for (int i = 0; i < config->getNumLooks(); i++) walk.look(config->getLookNameByIndex(i));
    for (int i = 0; i < config->getNumViewTransforms(); i++)
        walk.view_transform(config->getViewTransformNameByIndex(i));
}
