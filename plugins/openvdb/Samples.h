#pragma once

#include <osgVolumizer/core/voxels/Half.h>
#include <osgVolumizer/core/voxels/VoxelType.h>

#include <openvdb/openvdb.h>

#include <cstdint>
#include <type_traits>

namespace osgVolumizer {
namespace vdb {

// What the values of a tree become in memory. Each is made of such a value, and is a number.

/// Length of a vector.
template <class T>
struct Length
{
    T value;

    template <class U>
    explicit Length(const openvdb::math::Vec3<U>& v)
        : value(static_cast<T>(openvdb::math::Vec3<double>(v).length()))
    {
    }
    explicit Length(double v) : value(static_cast<T>(v)) {}
    explicit operator double() const { return static_cast<double>(value); }
};

/// One component of a vector.
template <class T, int COMPONENT>
struct Component
{
    T value;

    explicit Component(const openvdb::math::Vec3<T>& v) : value(v[COMPONENT]) {}
    explicit Component(double v) : value(static_cast<T>(v)) {}
    explicit operator double() const { return static_cast<double>(value); }
};

/// A 16-bit float.
struct HalfSample
{
    core::Half value;

    explicit HalfSample(double v) : value(static_cast<float>(v)) {}
    explicit operator double() const { return static_cast<double>(static_cast<float>(value)); }
};

/// The voxel type of what is in memory; of a plain number, or of one above.
template <class T>
constexpr VoxelType voxelTypeOf()
{
    if constexpr (std::is_same_v<T, std::int8_t>)
        return VoxelType::INT8;
    else if constexpr (std::is_same_v<T, std::uint8_t>)
        return VoxelType::UINT8;
    else if constexpr (std::is_same_v<T, std::int16_t>)
        return VoxelType::INT16;
    else if constexpr (std::is_same_v<T, std::uint16_t>)
        return VoxelType::UINT16;
    else if constexpr (std::is_same_v<T, std::int32_t>)
        return VoxelType::INT32;
    else if constexpr (std::is_same_v<T, std::uint32_t>)
        return VoxelType::UINT32;
    else if constexpr (std::is_same_v<T, core::Half>)
        return VoxelType::HALF;
    else if constexpr (std::is_same_v<T, float>)
        return VoxelType::FLOAT32;
    else if constexpr (std::is_same_v<T, double>)
        return VoxelType::FLOAT64;
    else
        return voxelTypeOf<decltype(T::value)>();
}

} // namespace vdb
} // namespace osgVolumizer
