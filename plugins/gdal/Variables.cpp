#include "Variables.h"

#include "Session.h"

#include <algorithm>

namespace osgVolumizer {
namespace gdal {

namespace {

constexpr int MOST_NESTED = 32;
constexpr std::size_t MOST_VARIABLES = 4096;

void collect(const std::shared_ptr<GDALGroup>& group, int depth, std::vector<Variable>& found)
{
    if (!group || depth > MOST_NESTED) return;
    for (const std::string& name : group->GetMDArrayNames()) {
        if (found.size() >= MOST_VARIABLES) return;
        const Array array = group->OpenMDArray(name);
        if (!array || !isNumeric(*array)) continue;
        const Variable variable{array->GetFullName(), array, group};
        if (variable.longAxes() >= 2 && array->GetTotalElementsCount() > 0)
            found.push_back(variable);
    }
    for (const std::string& name : group->GetGroupNames())
        collect(group->OpenGroup(name), depth + 1, found);
}

} // namespace

int Variable::longAxes() const
{
    const auto& dimensions = array->GetDimensions();
    return int(std::count_if(dimensions.begin(), dimensions.end(),
                             [](const Dimension& d) { return d->GetSize() > 1; }));
}

std::string Variable::text() const
{
    std::string sizes;
    for (const Dimension& dimension : array->GetDimensions())
        sizes += (sizes.empty() ? "" : ", ") + dimension->GetName() + " " +
                 std::to_string(dimension->GetSize());
    const std::string unit = unitOf(*array);
    return oneLine(array->GetName() + " (" + sizes + ")" + (unit.empty() ? "" : " " + unit));
}

std::vector<Variable> variablesOf(const std::shared_ptr<GDALGroup>& root)
{
    std::vector<Variable> found;
    collect(root, 0, found);
    return found;
}

} // namespace gdal
} // namespace osgVolumizer
