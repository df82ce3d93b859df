// One patient in three series: a CT with a tilted gantry, a sagittal MR, and a segmentation in
// NIfTI. A landmark lies at one place in all of them.

#ifdef OSGVOLUMIZER_HAVE_ITK

#include "DicomFiles.h"
#include "VolumeSums.h"

#include <osgVolumizer/ReadVolume.h>
#include <osgVolumizer/VolumeGeometry.h>
#include <osgVolumizer/WriteVoxels.h>
#include <osgVolumizer/core/Text.h>

#include <support/FolderTest.h>

#include <osg/NodeVisitor>
#include <osg/Transform>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace PatientTest {

using namespace osgVolumizer;
namespace fs = std::filesystem;

namespace {

const glm::dvec3 LANDMARK(12.3, -31.7, 845.2); // LPS, mm
constexpr double RADIUS = 4.0;                 // mm: one standard deviation

/// A smooth blob, which is nothing at the borders of the volumes.
double blob(const glm::dvec3& place)
{
    const double r = glm::distance(place, LANDMARK) / RADIUS;
    return std::exp(-0.5 * r * r);
}

std::string decimals(const glm::dvec3& v)
{
    return core::formatNumber(v.x) + "\\" + core::formatNumber(v.y) + "\\" +
           core::formatNumber(v.z);
}

/// `steps` has a column for each voxel axis: along columns, rows and slices.
void writeSeries(const fs::path& folder, const char* modality, const glm::ivec3& size,
                 const glm::dmat3& steps, const glm::dvec3& position, int background)
{
    fs::create_directories(folder);
    for (int k = 0; k < size.z; ++k) {
        DicomFile file;
        file.setSize(size.x, size.y);
        file.setBits(16, 12, 11, false);
        file.text(0x00080060, "CS", modality);
        file.text(0x00200013, "IS", std::to_string(size.z - k));
        if (background < 0) {
            file.text(0x00281052, "DS", std::to_string(background));
            file.text(0x00281053, "DS", "1");
        }
        file.text(0x00280030, "DS",
                  core::formatNumber(glm::length(steps[1])) + "\\" +
                      core::formatNumber(glm::length(steps[0])));
        const glm::dvec3 first = position + double(k) * steps[2];
        file.setPlace(decimals(first), decimals(glm::normalize(steps[0])) + "\\" +
                                           decimals(glm::normalize(steps[1])));
        std::vector<int> values;
        for (int j = 0; j < size.y; ++j)
            for (int i = 0; i < size.x; ++i)
                values.push_back(static_cast<int>(
                    std::lround(3000.0 * blob(first + steps * glm::dvec3(i, j, 0.0)))));
        file.setValues(values);
        std::ofstream(folder / ("IM" + std::to_string(k)), std::ios::binary) << file.bytes();
    }
}

void writeSegmentation(const std::string& name, const glm::ivec3& size, const glm::dmat3& steps,
                       const glm::dvec3& position)
{
    VoxelSource::Description d;
    d.size = size;
    d.type = VoxelType::UINT8;
    ASSERT_TRUE(io::place(d, steps, position).ok());
    const osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    ASSERT_TRUE(source->allocate(d).ok());
    auto* to = static_cast<unsigned char*>(source->data());
    for (int k = 0; k < size.z; ++k)
        for (int j = 0; j < size.y; ++j)
            for (int i = 0; i < size.x; ++i)
                *to++ = static_cast<unsigned char>(
                    std::lround(255.0 * blob(io::placeOf(d, glm::dvec3(i, j, k)))));
    const Status status = writeVoxels(*source, name);
    ASSERT_TRUE(status.ok()) << status.text;
}

/// Where the box of a volume is drawn.
struct FindBox : osg::NodeVisitor
{
    FindBox() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Drawable& drawable) override
    {
        if (!dynamic_cast<VolumeGeometry*>(&drawable)) return;
        matrix = osg::computeLocalToWorld(getNodePath());
        ++count;
    }
    osg::Matrixd matrix;
    int count = 0;
};

/// The middle of what is above the background, in the frame of the scene.
glm::dvec3 landmarkOf(const std::string& name)
{
    const auto volume = readVolume(name);
    EXPECT_TRUE(volume.ok()) << volume.status.text;
    if (!volume.ok()) return glm::dvec3(0.0);
    FindBox box;
    (*volume)->accept(box);
    EXPECT_EQ(box.count, 1);
    const Voxels& voxels = *(*volume)->getVoxels();
    const osg::Vec3d spacing = voxels.getSpacing(), origin = voxels.getOrigin();
    const std::vector<double> values = valuesOf(*voxels.getSource());
    const double background = *std::min_element(values.begin(), values.end());
    const osg::Vec3i size = voxels.getSize();
    osg::Vec3d sum;
    double weight = 0.0;
    std::size_t n = 0;
    for (int k = 0; k < size.z(); ++k)
        for (int j = 0; j < size.y(); ++j)
            for (int i = 0; i < size.x(); ++i) {
                const double w = values[n++] - background;
                sum += osg::Vec3d(i * spacing.x(), j * spacing.y(), k * spacing.z()) * w;
                weight += w;
            }
    const osg::Vec3d place = (sum / weight + origin) * box.matrix;
    return {place.x(), place.y(), place.z()};
}

class Patient : public support::FolderTest
{
protected:
    /// Three names.
    static std::vector<std::string> writeAll(const fs::path& folder)
    {
        const double tilt = std::tan(0.26);
        const glm::dmat3 ct(0.8, 0, 0, 0, 0.8, 0, 0, 2.0 * tilt, 2.0);
        writeSeries(folder / "ct", "CT", {64, 64, 32}, ct,
                    LANDMARK - ct * glm::dvec3(30.3, 34.2, 14.6), -1024);
        const glm::dmat3 mr(0, 0.9, 0, 0, 0, -0.9, -1.1, 0, 0); // rows to the back, columns down
        writeSeries(folder / "mr", "MR", {60, 62, 44}, mr,
                    LANDMARK - mr * glm::dvec3(27.6, 33.1, 20.8), 0);
        // Oblique, left-handed.
        const glm::dmat3 oblique(0.96, 0.28, 0, 0.28, -0.96, 0, 0, 0, 1.5);
        writeSegmentation((folder / "segmentation.nii.gz").string(), {56, 52, 36}, oblique,
                          LANDMARK - oblique * glm::dvec3(25.7, 28.4, 17.2));
        return {(folder / "ct").string(), (folder / "mr").string(),
                (folder / "segmentation.nii.gz").string()};
    }
};

TEST_F(Patient, ALandmarkLiesAtOnePlaceInAllSeries)
{
    for (const std::string& name : writeAll(folder())) {
        const Notices notices;
        const glm::dvec3 found = landmarkOf(name);
        EXPECT_LT(glm::distance(found, LANDMARK), 0.01)
            << name << ": " << found.x << ' ' << found.y << ' ' << found.z;
        EXPECT_EQ(notices.text(), "");
    }
}

TEST_F(Patient, SeriesLieOnEachOtherOnceStored)
{
    // A scene file keeps where they are.
    const std::string ct = writeAll(folder()).front();
    const auto volume = readVolume(ct);
    ASSERT_TRUE(volume.ok()) << volume.status.text;
    ASSERT_TRUE(osgDB::writeNodeFile(**volume, path("ct.osgb")));
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(path("ct.osgb"));
    ASSERT_TRUE(scene);
    FindBox before, after;
    (*volume)->accept(before);
    scene->accept(after);
    ASSERT_EQ(after.count, 1);
    for (int i = 0; i < 16; ++i)
        EXPECT_NEAR(after.matrix.ptr()[i], before.matrix.ptr()[i], 1e-12);
}

// For a person to look at: OSGVOLUMIZER_PATIENT=folder
TEST_F(Patient, AreWrittenWhereAPersonLooks)
{
    const char* wanted = std::getenv("OSGVOLUMIZER_PATIENT");
    const std::vector<std::string> names = writeAll(wanted ? fs::path(wanted) : folder());
    for (const std::string& name : names)
        EXPECT_TRUE(fs::exists(name)) << name;
}

} // namespace

} // namespace PatientTest

#endif
