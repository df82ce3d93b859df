#pragma once

#include <openvdb/openvdb.h>

namespace osgVolumizer {
namespace vdb {

/// Calls `leaf(node, part)` for each leaf of a node and `tile(value, part)` for each tile that has
/// something in common with `box`, which lies within the node: that part.
template <class Node, class Leaf, class Tile>
void visitNode(const Node& node, const openvdb::CoordBBox& box, const Leaf& leaf, const Tile& tile)
{
    if constexpr (Node::LEVEL == 0) {
        leaf(node, box);
    } else {
        using openvdb::Coord;
        using Child = typename Node::ChildNodeType;
        Coord at, end;
        for (at[0] = box.min()[0]; at[0] <= box.max()[0]; at[0] = end[0] + 1)
            for (at[1] = box.min()[1]; at[1] <= box.max()[1]; at[1] = end[1] + 1)
                for (at[2] = box.min()[2]; at[2] <= box.max()[2]; at[2] = end[2] + 1) {
                    const openvdb::Index n = Node::coordToOffset(at);
                    end = Coord::minComponent(box.max(),
                                              node.offsetToGlobalCoord(n).offsetBy(Child::DIM - 1));
                    const openvdb::CoordBBox part(at, end);
                    const auto& entry = node.getTable()[n];
                    if (node.isChildMaskOn(n))
                        visitNode(*entry.getChild(), part, leaf, tile);
                    else
                        tile(entry.getValue(), part);
                }
    }
}

/// The same for a tree. False where some of the box is in no node: it has the background's value.
template <class Tree, class Leaf, class Tile>
bool visitTree(const Tree& tree, const openvdb::CoordBBox& box, const Leaf& leaf, const Tile& tile)
{
    using Child = typename Tree::RootNodeType::ChildNodeType;
    openvdb::Index64 left = box.volume();
    const auto partOf = [&](const openvdb::Coord& origin) {
        openvdb::CoordBBox part = openvdb::CoordBBox::createCube(origin, Child::DIM);
        part.intersect(box);
        if (!part.empty()) left -= part.volume();
        return part;
    };
    for (auto child = tree.root().cbeginChildOn(); child; ++child)
        if (const auto part = partOf(child.getCoord()); !part.empty())
            visitNode(*child, part, leaf, tile);
    for (auto value = tree.root().cbeginValueAll(); value; ++value)
        if (const auto part = partOf(value.getCoord()); !part.empty()) tile(*value, part);
    return left == 0;
}

} // namespace vdb
} // namespace osgVolumizer
