#pragma once

#include "ProgramFeatures.h"

#include <string>
#include <vector>

namespace osgVolumizer {
namespace render {

/// What the names of one of several volumes end with in a program that marches all of them.
std::string memberSuffix(std::size_t number);

/// Shader code that marches one volume, or several of features of their own: findParts() and
/// lightBetween(). Expects march.glsl and segment.glsl before it.
/// \param inOrder the members do not overlap, and come far to near: see inorder.glsl and fused.glsl
std::string marchSource(const ProgramFeatures& volume);
std::string marchSource(const std::vector<ProgramFeatures>& members, bool inOrder);

/// Shader code that any volume's begins with, marched or in slices: its voxels, table, light,
/// paint.
std::string volumeSource(const ProgramFeatures& volume);

} // namespace render
} // namespace osgVolumizer
