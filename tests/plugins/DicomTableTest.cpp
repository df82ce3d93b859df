// The test files that come with pydicom, against what other programs read of them: pydicom those
// without compression and of run lengths, DCMTK those of JPEG and JPEG-LS, OpenJPEG those of JPEG
// 2000; rescaled, colours as their luminance. Its folder is in Debian's python3-pydicom.

#ifdef OSGVOLUMIZER_HAVE_ITK

#include "VolumeSums.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

namespace DicomTableTest {

using namespace osgVolumizer;
namespace fs = std::filesystem;

namespace {

const std::string FOLDER = "/usr/lib/python3/dist-packages/pydicom/data/test_files/";

struct Opened
{
    const char* name;
    glm::ivec3 size;
    const char* type;
    double sum, weighted; ///< see VolumeSums
    glm::dvec3 position;  ///< ImagePositionPatient, or none
};

// badVR.dcm and SC_rgb_jpeg.dcm are as rtdose_1frame.dcm and SC_rgb_jpeg_dcmd.dcm: no other program
// reads them.
const Opened OPENED[] = {
    {"693_J2KI.dcm", {512, 512, 1}, "int16", -270617240, -129268406174, {-122.5, -112.4, 47}},
    {"CT_small.dcm",
     {128, 128, 1},
     "int16",
     -1950906,
     -920133636,
     {-158.135803, -179.035797, -75.699997}},
    {"ExplVR_BigEnd.dcm", {80, 60, 1}, "uint8", 1114767, 546006120, {0, 0, 0}},
    {"GDCMJ2K_TextGBR.dcm", {400, 400, 1}, "uint8", 20067140, 10236082707, {0, 0, 0}},
    {"J2K_pixelrep_mismatch.dcm",
     {512, 512, 1},
     "int16",
     -172605258,
     -81946376366,
     {-110.2153, -98.1898, 72.1446}},
    {"JPEG-lossy.dcm", {256, 1024, 1}, "uint16", 3767007, 1935775038, {0, 0, 0}},
    {"JPEG2000.dcm", {256, 1024, 1}, "int16", 3527976, 1810504586, {0, 0, 0}},
    {"JPGExtended.dcm", {256, 1024, 1}, "uint16", 3767007, 1935775038, {0, 0, 0}},
    {"MR_small.dcm", {64, 64, 1}, "int16", 2125338, 1136129015, {-83.9063, -91.2, 6.6406}},
    {"MR_small_RLE.dcm", {64, 64, 1}, "int16", 2125338, 1136129015, {-83.9063, -91.2, 6.6406}},
    {"MR_small_bigendian.dcm",
     {64, 64, 1},
     "int16",
     2125338,
     1136129015,
     {-83.9063, -91.2, 6.6406}},
    {"MR_small_expb.dcm", {64, 64, 1}, "int16", 2125338, 1136129015, {-83.9063, -91.2, 6.6406}},
    {"MR_small_implicit.dcm", {64, 64, 1}, "int16", 2125338, 1136129015, {-83.9063, -91.2, 6.6406}},
    {"MR_small_jp2klossless.dcm",
     {64, 64, 1},
     "int16",
     2125338,
     1136129015,
     {-83.9063, -91.2, 6.6406}},
    {"MR_small_jpeg_ls_lossless.dcm",
     {64, 64, 1},
     "int16",
     2125338,
     1136129015,
     {-83.9063, -91.2, 6.6406}},
    {"MR_small_padded.dcm", {64, 64, 1}, "int16", 2125338, 1136129015, {-83.9063, -91.2, 6.6406}},
    {"SC_jpeg_no_color_transform.dcm", {256, 256, 1}, "uint8", 15989285, 8151123121, {0, 0, 0}},
    {"SC_jpeg_no_color_transform_2.dcm", {256, 256, 1}, "uint8", 16094439, 8204887331, {0, 0, 0}},
    {"SC_rgb_dcmtk_+eb+cr.dcm", {100, 100, 1}, "uint8", 1276500, 641712806, {0, 0, 0}},
    {"SC_rgb_dcmtk_+eb+cy+n1.dcm", {100, 100, 1}, "uint8", 1276950, 642579541, {0, 0, 0}},
    {"SC_rgb_dcmtk_+eb+cy+n2.dcm", {100, 100, 1}, "uint8", 1276200, 641787592, {0, 0, 0}},
    {"SC_rgb_dcmtk_+eb+cy+np.dcm", {100, 100, 1}, "uint8", 1276950, 642579541, {0, 0, 0}},
    {"SC_rgb_dcmtk_+eb+cy+s2.dcm", {100, 100, 1}, "uint8", 1276200, 641787592, {0, 0, 0}},
    {"SC_rgb_dcmtk_+eb+cy+s4.dcm", {100, 100, 1}, "uint8", 1276200, 641787592, {0, 0, 0}},
    {"SC_rgb_gdcm_KY.dcm", {100, 100, 1}, "uint8", 1276000, 641377492, {0, 0, 0}},
    {"SC_rgb_jpeg.dcm", {256, 256, 1}, "uint8", 15989285, 8151123121, {0, 0, 0}},
    {"SC_rgb_jpeg_app14_dcmd.dcm", {256, 256, 1}, "uint8", 16094439, 8204887331, {0, 0, 0}},
    {"SC_rgb_jpeg_dcmd.dcm", {256, 256, 1}, "uint8", 15989285, 8151123121, {0, 0, 0}},
    {"SC_rgb_jpeg_dcmtk.dcm", {100, 100, 1}, "uint8", 1276200, 641787592, {0, 0, 0}},
    {"SC_rgb_jpeg_gdcm.dcm", {100, 100, 1}, "uint8", 1276000, 641377492, {0, 0, 0}},
    {"SC_rgb_jpeg_lossy_gdcm.dcm", {100, 100, 1}, "uint8", 1279050, 643115190, {0, 0, 0}},
    {"SC_rgb_rle.dcm", {100, 100, 1}, "uint8", 1276000, 641377492, {0, 0, 0}},
    {"SC_rgb_rle_16bit.dcm", {100, 100, 1}, "uint16", 328190000, 164963455790, {0, 0, 0}},
    {"SC_rgb_rle_16bit_2frame.dcm", {100, 100, 2}, "uint16", 655350000, 330745992675, {0, 0, 0}},
    {"SC_rgb_rle_2frame.dcm", {100, 100, 2}, "uint8", 2550000, 1286953815, {0, 0, 0}},
    {"SC_rgb_rle_32bit.dcm", {100, 100, 1}, "uint32", 21508522494000, 10811177107145836, {0, 0, 0}},
    {"SC_rgb_rle_32bit_2frame.dcm",
     {100, 100, 2},
     "uint32",
     42949672950000,
     21676100410955232,
     {0, 0, 0}},
    {"SC_rgb_small_odd.dcm", {3, 3, 1}, "uint8", 1158, 5952, {0, 0, 0}},
    {"SC_rgb_small_odd_jpeg.dcm", {3, 3, 1}, "uint8", 1158, 5952, {0, 0, 0}},
    {"SC_ybr_full_422_uncompressed.dcm", {100, 100, 1}, "uint8", 1276200, 641787592, {0, 0, 0}},
    {"badVR.dcm",
     {10, 10, 1},
     "float32",
     101.37799978256226,
     4706.0669961571693,
     {189.43125, 199.43125, -761.87}},
    {"dicomdirtests/77654033/CR1/6154",
     {16, 16, 1},
     "float32",
     493126.24400000006,
     64002548.576000012,
     {0, 0, 0}},
    {"dicomdirtests/77654033/CR2/6247",
     {16, 16, 1},
     "float32",
     324767.85200000001,
     41524855.076000005,
     {0, 0, 0}},
    {"dicomdirtests/77654033/CR3/6278",
     {16, 16, 1},
     "float32",
     470592.54800000007,
     58739444.228,
     {0, 0, 0}},
    {"dicomdirtests/77654033/CT2/17106",
     {16, 16, 1},
     "int16",
     -158395,
     -19277273,
     {-125, -128.100006, -99.480003}},
    {"dicomdirtests/77654033/CT2/17136",
     {16, 16, 1},
     "uint16",
     140192,
     18067407,
     {-125, -128.100006, 103.019997}},
    {"dicomdirtests/77654033/CT2/17166",
     {16, 16, 1},
     "uint16",
     360990,
     46026853,
     {-125, -128.100006, 104.269997}},
    {"dicomdirtests/77654033/CT2/17196",
     {16, 16, 1},
     "uint16",
     228448,
     30020368,
     {-125, -128.100006, 105.519997}},
    {"dicomdirtests/98892001/CT2N/6293", {16, 16, 1}, "uint16", 68221, 8838053, {0, 265, 50}},
    {"dicomdirtests/98892001/CT2N/6924", {16, 16, 1}, "uint16", 30886, 3916509, {-265, 0, 50}},
    {"dicomdirtests/98892001/CT5N/2062",
     {16, 16, 1},
     "int16",
     -90697,
     -12364450,
     {-72.199997, -143, 8.7625}},
    {"dicomdirtests/98892001/CT5N/2392",
     {16, 16, 1},
     "int16",
     -48364,
     -6843217,
     {-72.199997, -143, 6.2625}},
    {"dicomdirtests/98892001/CT5N/2693",
     {16, 16, 1},
     "int16",
     -10964,
     -1679017,
     {-72.199997, -143, 3.7625}},
    {"dicomdirtests/98892001/CT5N/3023",
     {16, 16, 1},
     "int16",
     -9701,
     -723167,
     {-72.199997, -143, 1.2625}},
    {"dicomdirtests/98892001/CT5N/3353",
     {16, 16, 1},
     "int16",
     -17594,
     -1796770,
     {-72.199997, -143, -1.2375}},
    {"dicomdirtests/98892003/MR1/15820", {16, 16, 1}, "int16", 140730, 17861957, {0, -175, 175}},
    {"dicomdirtests/98892003/MR1/4919", {16, 16, 1}, "int16", 183241, 23564675, {0, -175, 175}},
    {"dicomdirtests/98892003/MR1/5641", {16, 16, 1}, "int16", 156143, 20371840, {0, -175, 175}},
    {"dicomdirtests/98892003/MR2/15970", {16, 16, 1}, "int16", 59831, 7389359, {0, -175, 175}},
    {"dicomdirtests/98892003/MR2/4950",
     {16, 16, 1},
     "int16",
     171698,
     22279112,
     {-153.5926, 2.08926, 168.1641}},
    {"dicomdirtests/98892003/MR2/4981",
     {16, 16, 1},
     "int16",
     177641,
     23142284,
     {-150, -149.3036, 18.75}},
    {"dicomdirtests/98892003/MR2/5011",
     {16, 16, 1},
     "int16",
     165548,
     21549957,
     {-0.696426, -149.4141, 168.1641}},
    {"dicomdirtests/98892003/MR2/6273",
     {16, 16, 1},
     "int16",
     161791,
     21035311,
     {-150, -146.1786, 11.875}},
    {"dicomdirtests/98892003/MR2/6605",
     {16, 16, 1},
     "int16",
     149273,
     19473096,
     {-0.696426, -146.2891, 161.2891}},
    {"dicomdirtests/98892003/MR2/6935",
     {16, 16, 1},
     "int16",
     156380,
     20330289,
     {-153.5926, 5.21426, 161.2891}},
    {"dicomdirtests/98892003/MR700/4467",
     {16, 16, 1},
     "int16",
     15714,
     2001211,
     {-78.63148, -72.91145, 98.89108}},
    {"dicomdirtests/98892003/MR700/4528",
     {16, 16, 1},
     "int16",
     20777,
     2811932,
     {-109.1489, -25.54486, 99.22289}},
    {"dicomdirtests/98892003/MR700/4558",
     {16, 16, 1},
     "int16",
     38927,
     4543091,
     {-113.2319, 2.623722, 99.40138}},
    {"dicomdirtests/98892003/MR700/4588",
     {16, 16, 1},
     "int16",
     16180,
     1981353,
     {-97.29537, -51.42206, 99.04807}},
    {"dicomdirtests/98892003/MR700/4618",
     {16, 16, 1},
     "int16",
     15206,
     1918257,
     {-54.6693, -88.27211, 98.76465}},
    {"dicomdirtests/98892003/MR700/4648",
     {16, 16, 1},
     "int16",
     7223,
     464608,
     {1.112873, -96.2268, 98.64109}},
    {"dicomdirtests/98892003/MR700/4678",
     {16, 16, 1},
     "int16",
     7642,
     538050,
     {-27.35009, -96.25959, 98.679}},
    {"image_dfl.dcm", {512, 512, 1}, "uint8", 33322688, 16536159271, {0, 0, 0}},
    {"liver_1frame.dcm", {512, 512, 1}, "uint8", 36233, 16369379, {0, 0, 0}},
    {"liver_expb_1frame.dcm", {512, 512, 1}, "uint8", 36233, 16369379, {0, 0, 0}},
    {"rtdose.dcm",
     {10, 10, 15},
     "float32",
     1519.9099996089935,
     643174.96946525574,
     {189.43125, 199.43125, -761.87}},
    {"rtdose_1frame.dcm",
     {10, 10, 1},
     "float32",
     101.37799978256226,
     4706.0669961571693,
     {189.43125, 199.43125, -761.87}},
    {"rtdose_expb.dcm",
     {10, 10, 15},
     "float32",
     1519.9099996089935,
     643174.96946525574,
     {189.43125, 199.43125, -761.87}},
    {"rtdose_expb_1frame.dcm",
     {10, 10, 1},
     "float32",
     101.37799978256226,
     4706.0669961571693,
     {189.43125, 199.43125, -761.87}},
    {"rtdose_rle.dcm",
     {10, 10, 15},
     "float32",
     1519.9099996089935,
     643174.96946525574,
     {189.43125, 199.43125, -761.87}},
    {"rtdose_rle_1frame.dcm",
     {10, 10, 1},
     "float32",
     101.37799978256226,
     4706.0669961571693,
     {189.43125, 199.43125, -761.87}},
};

struct Refused
{
    const char *name, *text;
};

const Refused REFUSED[] = {
    {"ExplVR_BigEndNoMeta.dcm", "has no image: it is of the kind \"RT Ion Plan Storage\""},
    {"ExplVR_LitEndNoMeta.dcm", "has no image: it is of the kind \"RT Ion Plan Storage\""},
    {"JPEG2000-embedded-sequence-delimiter.dcm", "has pixels that cannot be decoded (JPEG 2000"},
    {"MR_truncated.dcm", "has 8130 bytes of pixels, which need 8192"},
    {"UN_sequence.dcm", "has no image: it is of the kind \"CT Image Storage\""},
    {"dicomdirtests/DICOMDIR", "has no image: it is a directory of DICOM files: open its folder"},
    {"dicomdirtests/DICOMDIR-bigEnd",
     "has no image: it is a directory of DICOM files: open its folder"},
    {"dicomdirtests/DICOMDIR-empty.dcm",
     "has no image: it is a directory of DICOM files: open its folder"},
    {"dicomdirtests/DICOMDIR-implicit",
     "has no image: it is a directory of DICOM files: open its folder"},
    {"dicomdirtests/DICOMDIR-nooffset",
     "has no image: it is a directory of DICOM files: open its folder"},
    {"dicomdirtests/DICOMDIR-nopatient",
     "has no image: it is a directory of DICOM files: open its folder"},
    {"dicomdirtests/DICOMDIR-reordered",
     "has no image: it is a directory of DICOM files: open its folder"},
    {"dicomdirtests/TINY_ALPHA/DICOMDIR",
     "has no image: it is a directory of DICOM files: open its folder"},
    {"empty_charset_LEI.dcm", "has no image"},
    {"meta_missing_tsyntax.dcm", "cannot be read as DICOM"},
    {"nested_priv_SQ.dcm", "has no image"},
    {"no_meta.dcm", "cannot be read as DICOM"},
    {"no_meta_group_length.dcm", "has no image: it is of the kind \"RT Image Storage\""},
    {"priv_SQ.dcm", "has no image: it is of the kind \"MR Image Storage\""},
    {"reportsi.dcm", "has no image: it is of the kind \"Basic Text SR Storage\""},
    {"reportsi_with_empty_number_tags.dcm",
     "has no image: it is of the kind \"Basic Text SR Storage\""},
    {"rtplan.dcm", "has no image: it is of the kind \"RT Plan Storage\""},
    {"rtplan_truncated.dcm", "is cut short or damaged within its elements"},
    {"rtstruct.dcm", "has no image: it is of the kind \"RT Structure Set Storage\""},
    {"test-SR.dcm", "has no image: it is of the kind \"Comprehensive SR Storage\""},
    {"waveform_ecg.dcm", "has no image: it is of the kind \"12-lead ECG Waveform Storage\""},
};

// Slices without pixels.
const std::string EMPTY = "dicomdirtests/TINY_ALPHA/PT000000/ST000000/SE000000/";

bool isThere()
{
    std::error_code ignored;
    if (fs::is_directory(FOLDER, ignored)) return true;
    std::cout << FOLDER << " is missing (Debian: python3-pydicom): nothing was compared\n";
    return false;
}

Result<osg::ref_ptr<Voxels>> readQuietly(const std::string& path)
{
    const Notices notices;
    return readVoxels(path);
}

TEST(DicomTable, OpensWithTheValuesThatOthersRead)
{
    if (!isThere()) return;
    int count = 0;
    for (const Opened& file : OPENED) {
        SCOPED_TRACE(file.name);
        const auto voxels = readQuietly(FOLDER + file.name);
        EXPECT_TRUE(voxels.ok()) << voxels.status.text;
        if (!voxels.ok()) continue;
        ++count;
        const VolumeSums sums = sumsOf(*(*voxels)->getSource());
        EXPECT_EQ(sums.size, file.size);
        EXPECT_EQ(sums.type, file.type);
        const double tolerance = sums.type == "float32" ? 1e-7 : 1e-14; // of rounding
        EXPECT_NEAR(sums.sum, file.sum, tolerance * std::abs(file.sum));
        EXPECT_NEAR(sums.weighted, file.weighted, 100 * tolerance * std::abs(file.weighted));
        EXPECT_LT(glm::distance(sums.position, file.position), 1e-6);
    }
    EXPECT_EQ(count, 81);
}

TEST(DicomTable, RefusesOthersForWhatTheyAre)
{
    if (!isThere()) return;
    for (const Refused& file : REFUSED) {
        const auto voxels = readQuietly(FOLDER + file.name);
        EXPECT_FALSE(voxels.ok()) << file.name;
        EXPECT_EQ(voxels.status.text.find(FOLDER + file.name + ' ' + file.text), 0u)
            << voxels.status.text;
    }
    int empty = 0;
    for (const auto& entry : fs::directory_iterator(FOLDER + EMPTY)) {
        const auto voxels = readQuietly(entry.path().string());
        EXPECT_NE(voxels.status.text.find("has no image: it is of the kind \"CT Image Storage\""),
                  std::string::npos)
            << entry.path();
        ++empty;
    }
    EXPECT_EQ(empty, 50);
    EXPECT_EQ(std::end(REFUSED) - std::begin(REFUSED), 26);
}

TEST(DicomTable, HasEveryFileOfThePackage)
{
    if (!isThere()) return;
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(FOLDER)) {
        const std::string name = entry.path().string().substr(FOLDER.size());
        const std::string end = entry.path().extension().string();
        const bool other = end == ".txt" || end == ".dump" || end == ".json" || end == ".gz" ||
                           entry.path().filename() == "README";
        if (!entry.is_regular_file() || other || name.compare(0, EMPTY.size(), EMPTY) == 0)
            continue;
        ++files;
        const auto same = [&name](const auto& file) { return name == file.name; };
        EXPECT_TRUE(std::any_of(std::begin(OPENED), std::end(OPENED), same) ||
                    std::any_of(std::begin(REFUSED), std::end(REFUSED), same))
            << name;
    }
    EXPECT_EQ(files, 107);
}

} // namespace

} // namespace DicomTableTest

#endif
