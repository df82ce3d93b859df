#include "PageLayout.h"

#include "../core/Text.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace osgVolumizer {
namespace io {

namespace {

constexpr const char* MICROMETRES = "micrometres";
constexpr const char *OUR_SPACING = "osgVolumizer.spacing", *OUR_ORIGIN = "osgVolumizer.origin",
                     *OUR_AXES = "osgVolumizer.axes";

using Attributes = std::map<std::string, std::string, std::less<>>;

std::optional<double> micrometresOf(std::string_view unit)
{
    static const struct
    {
        std::string_view name;
        double length;
    } units[] = {{"um", 1.0},         {"micron", 1.0},     {"microns", 1.0},   {"micrometer", 1.0},
                 {"micrometre", 1.0}, {"\xc2\xb5m", 1.0},  {"\xce\xbcm", 1.0}, {"\xb5m", 1.0},
                 {"\\u00B5m", 1.0},   {"&#181;m", 1.0},    {"&#xb5;m", 1.0},   {"&#xB5;m", 1.0},
                 {"nm", 1e-3},        {"nanometer", 1e-3}, {"pm", 1e-6},       {"\xc3\x85", 1e-4},
                 {"mm", 1e3},         {"millimeter", 1e3}, {"cm", 1e4},        {"centimeter", 1e4},
                 {"m", 1e6},          {"meter", 1e6},      {"inch", 25400.0},  {"in", 25400.0}};
    for (const auto& u : units)
        if (u.name == unit) return u.length;
    return std::nullopt;
}

// A whole number from 1, or what it is where there is none.
int countOf(const Attributes& values, std::string_view name, int otherwise)
{
    const auto found = values.find(name);
    std::int64_t n = 0;
    if (found == values.end() || !core::parseInteger(found->second, n) || n < 0 || n > 1 << 24)
        return otherwise;
    return static_cast<int>(n);
}

double numberOf(const Attributes& values, std::string_view name)
{
    const auto found = values.find(name);
    double v = 0.0;
    if (found == values.end() || !core::parseNumber(found->second, v) || !std::isfinite(v))
        return 0.0;
    return v;
}

bool isSpacing(double v)
{
    return v >= 1e-18 && v <= 1e18;
}

bool matches(const PageLayout& layout, std::int64_t pages)
{
    return layout.slices > 0 && layout.channels > 0 && layout.steps > 0 &&
           std::int64_t(layout.slices) * layout.channels <= pages &&
           std::int64_t(layout.slices) * layout.channels * layout.steps == pages;
}

std::string mismatch(const PageLayout& said, int pages)
{
    return "it says that it has " + std::to_string(said.slices) + " slices, " +
           std::to_string(said.channels) + " channels and " + std::to_string(said.steps) +
           " time steps, but it has " + std::to_string(pages) + " pages, which are taken as slices";
}

// name=value, a line each.
Attributes linesOf(std::string_view text)
{
    Attributes values;
    for (std::string_view line : core::splitText(text, '\n')) {
        while (!line.empty() && line.back() == '\r')
            line.remove_suffix(1);
        const std::size_t equals = line.find('=');
        if (equals != std::string_view::npos)
            values.emplace(line.substr(0, equals), line.substr(equals + 1));
    }
    return values;
}

void setSpacing(PageLayout& layout, const glm::dvec3& spacing)
{
    for (int i = 0; i < 3; ++i) {
        if (isSpacing(spacing[i])) layout.spacing[i] = spacing[i];
    }
}

void parseImageJ(const Attributes& values, const PageLayout::File& file, PageLayout& layout,
                 std::vector<int>& pages)
{
    const int images = countOf(values, "images", 1);
    layout.channels = countOf(values, "channels", 1);
    layout.steps = countOf(values, "frames", 1);
    layout.slices = countOf(values, "slices", 1);
    layout.single = file.pages == 1 && images > 1;
    const int there = layout.single ? images : file.pages;
    if (!matches(layout, there)) {
        if (layout.channels > 1 || layout.steps > 1)
            layout.notices.push_back(mismatch(layout, there));
        layout.channels = layout.steps = 1;
        layout.slices = there;
    }
    const bool calibrated = values.count("c0") && values.count("c1");
    layout.isSigned =
        calibrated && numberOf(values, "c0") == -32768.0 && numberOf(values, "c1") == 1.0;
    if (calibrated && !layout.isSigned)
        layout.notices.push_back("its calibration of values is not applied");
    if (layout.channels > 1 || layout.steps > 1)
        for (int t = 0; t < layout.steps; ++t)
            for (int c = 0; c < layout.channels; ++c)
                for (int z = 0; z < layout.slices; ++z)
                    pages.push_back((t * layout.slices + z) * layout.channels + c);
    const auto unit = values.find("unit");
    std::optional<double> length;
    if (unit != values.end()) {
        length = micrometresOf(unit->second);
        layout.unit = length ? MICROMETRES : unit->second;
    }
    glm::dvec3 spacing(0.0, 0.0, numberOf(values, "spacing"));
    if (isSpacing(file.xResolution)) spacing.x = 1.0 / file.xResolution;
    if (isSpacing(file.yResolution)) spacing.y = 1.0 / file.yResolution;
    const auto y = values.find("yunit"), z = values.find("zunit");
    const auto scaleOf = [&](Attributes::const_iterator own) {
        const auto other = own == values.end() ? std::nullopt : micrometresOf(own->second);
        return other ? *other : length.value_or(1.0);
    };
    setSpacing(layout, spacing * glm::dvec3(length.value_or(1.0), scaleOf(y), scaleOf(z)));
}

// The attributes of the next element of that name, whatever its namespace, from `at` on, which is
// then behind it; false where there is none.
bool nextElement(std::string_view xml, std::string_view name, std::size_t& at, Attributes& values)
{
    for (;; ++at) {
        at = xml.find(name, at);
        if (at == std::string_view::npos || at == 0) return false;
        const char before = xml[at - 1];
        const std::size_t behind = at + name.size();
        if ((before == '<' || before == ':') && behind < xml.size() &&
            std::string_view(" \t\r\n/>").find(xml[behind]) != std::string_view::npos)
            break;
    }
    values.clear();
    at += name.size();
    for (;;) {
        at = xml.find_first_not_of(" \t\r\n", at);
        if (at == std::string_view::npos) return false;
        if (xml[at] == '>' || xml[at] == '/') return true;
        const std::size_t equals = xml.find('=', at);
        if (equals == std::string_view::npos || equals + 2 >= xml.size()) return false;
        const char quote = xml[equals + 1];
        const std::size_t end = xml.find(quote, equals + 2);
        if ((quote != '"' && quote != '\'') || end == std::string_view::npos) return false;
        values.emplace(xml.substr(at, equals - at), xml.substr(equals + 2, end - equals - 2));
        at = end + 1;
    }
}

// Pages by slice, channel and step for an order of dimensions as in "XYZCT".
std::vector<int> pagesInOrder(const PageLayout& layout, std::string_view order)
{
    const auto stride = [&](char axis) {
        int n = 1;
        for (const char a : order.substr(2)) {
            if (a == axis) return n;
            n *= a == 'Z' ? layout.slices : a == 'C' ? layout.channels : layout.steps;
        }
        return n;
    };
    const int z1 = stride('Z'), c1 = stride('C'), t1 = stride('T');
    std::vector<int> pages;
    for (int t = 0; t < layout.steps; ++t)
        for (int c = 0; c < layout.channels; ++c)
            for (int z = 0; z < layout.slices; ++z)
                pages.push_back(z * z1 + c * c1 + t * t1);
    return pages;
}

// Single planes that say in which page they are.
void placePlanes(std::string_view xml, std::size_t at, const PageLayout& layout, int pageCount,
                 std::vector<int>& pages)
{
    const std::string_view inside = xml.substr(0, xml.find("Pixels>", at));
    Attributes data;
    while (nextElement(inside, "TiffData", at, data)) {
        const int z = countOf(data, "FirstZ", 0), c = countOf(data, "FirstC", 0),
                  t = countOf(data, "FirstT", 0), page = countOf(data, "IFD", -1);
        if (page < 0 || page >= pageCount || countOf(data, "PlaneCount", 1) != 1 ||
            z >= layout.slices || c >= layout.channels || t >= layout.steps)
            continue;
        pages[std::size_t((t * layout.channels + c) * layout.slices + z)] = page;
    }
}

void parseOme(std::string_view xml, const PageLayout::File& file, PageLayout& layout,
              std::vector<int>& pages)
{
    std::size_t at = 0;
    Attributes pixels;
    if (!nextElement(xml, "Pixels", at, pixels)) return;
    glm::dvec3 spacing(0.0);
    static constexpr const char* names[] = {"PhysicalSizeX", "PhysicalSizeY", "PhysicalSizeZ"};
    for (int i = 0; i < 3; ++i) {
        const auto unit = pixels.find(names[i] + std::string("Unit"));
        const auto length = unit == pixels.end() ? 1.0 : micrometresOf(unit->second);
        spacing[i] = numberOf(pixels, names[i]) * length.value_or(1.0);
        layout.unit = length ? MICROMETRES : unit->second;
    }
    setSpacing(layout, spacing);
    PageLayout said = layout;
    said.slices = countOf(pixels, "SizeZ", 1);
    said.channels = countOf(pixels, "SizeC", 1);
    said.steps = countOf(pixels, "SizeT", 1);
    if (file.samples > 1 && said.channels % file.samples == 0) said.channels /= file.samples;
    const auto found = pixels.find("DimensionOrder");
    const std::string order = found == pixels.end() ? "XYZCT" : found->second;
    const bool known = order.size() == 5 && order.compare(0, 2, "XY") == 0 &&
                       order.find('Z') != order.npos && order.find('C') != order.npos &&
                       order.find('T') != order.npos;
    if (known && matches(said, file.pages)) {
        layout = said;
        pages = pagesInOrder(layout, order);
        placePlanes(xml, at, layout, file.pages, pages);
    } else if (said.slices != file.pages) {
        layout.notices.push_back(mismatch(said, file.pages));
    }
}

void parseOwn(const Attributes& values, PageLayout& layout)
{
    const auto read = [&](const char* name, double* to, int count) {
        const auto found = values.find(name);
        return found != values.end() && core::parseNumbers(found->second, to, count) &&
               std::all_of(to, to + count, [](double v) { return std::isfinite(v); });
    };
    glm::dvec3 spacing, origin;
    glm::dmat3 axes;
    if (!read(OUR_SPACING, &spacing.x, 3) || !read(OUR_ORIGIN, &origin.x, 3) ||
        !read(OUR_AXES, &axes[0].x, 9) || !(std::abs(glm::determinant(axes)) > 1e-6))
        return;
    setSpacing(layout, spacing);
    layout.origin = origin;
    layout.axes = axes;
}

} // namespace

int PageLayout::page(int slice, int channel, int step) const
{
    const auto at = (std::int64_t(step) * channels + channel) * slices + slice;
    return _pages.empty() ? static_cast<int>(at) : _pages[std::size_t(at)];
}

PageLayout PageLayout::parse(std::string_view description, const File& file)
{
    PageLayout layout;
    layout.slices = file.pages;
    if (description.substr(0, 7) == "ImageJ=") {
        const Attributes values = linesOf(description);
        parseImageJ(values, file, layout, layout._pages);
        parseOwn(values, layout);
    } else if (description.find("<OME") != description.npos ||
               description.find(":OME") != description.npos) {
        parseOme(description, file, layout, layout._pages);
    }
    return layout;
}

std::string PageLayout::text(const VoxelSource::Description& d)
{
    const std::string slices = std::to_string(d.size.z);
    return "ImageJ=1.11a\nimages=" + slices + "\nslices=" + slices +
           "\nspacing=" + core::formatNumber(d.spacing.z) + "\n" + OUR_SPACING + "=" +
           core::formatNumbers(&d.spacing.x, 3) + "\n" + OUR_ORIGIN + "=" +
           core::formatNumbers(&d.origin.x, 3) + "\n" + OUR_AXES + "=" +
           core::formatNumbers(&d.axes[0].x, 9) + "\n";
}

} // namespace io
} // namespace osgVolumizer
