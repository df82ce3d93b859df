#include "LatticeDragger.h"

#include "private/HandleShapes.h"

#include <osg/MatrixTransform>

#include <algorithm>

namespace osgVolumizer {

namespace {

constexpr double BALL_SHARE = 0.07; // of the distance of neighbours at rest

double ballRadius(const LatticeDeformer& lattice)
{
    const osg::Vec3d step =
        lattice.getRestPoint(lattice.numberOf(1, 1, 1)) - lattice.getRestPoint(0);
    return BALL_SHARE * std::min({step.x(), step.y(), step.z()});
}

// Between neighbours, relative to `about`.
std::vector<osg::Vec3d> linesOf(const LatticeDeformer& lattice, const osg::Vec3d& about)
{
    const osg::Vec3i n = lattice.getNumPoints();
    std::vector<osg::Vec3d> lines;
    const auto add = [&](unsigned a, unsigned b) {
        lines.push_back(lattice.getPoint(a) - about);
        lines.push_back(lattice.getPoint(b) - about);
    };
    for (int k = 0; k < n.z(); ++k)
        for (int j = 0; j < n.y(); ++j)
            for (int i = 0; i < n.x(); ++i) {
                const unsigned here = lattice.numberOf(i, j, k);
                if (i + 1 < n.x()) add(here, lattice.numberOf(i + 1, j, k));
                if (j + 1 < n.y()) add(here, lattice.numberOf(i, j + 1, k));
                if (k + 1 < n.z()) add(here, lattice.numberOf(i, j, k + 1));
            }
    return lines;
}

} // namespace

LatticeDragger::LatticeDragger(LatticeDeformer* lattice)
    : _lattice(lattice), _lines(handleShapes::makeLines())
{
    for (unsigned i = 0; i < lattice->getNumAllPoints(); ++i)
        addDragger(handleShapes::makePointDragger());
    osg::ref_ptr<osg::MatrixTransform> about =
        new osg::MatrixTransform(osg::Matrixd::translate(lattice->getRestPoint(0)));
    about->setDataVariance(osg::Object::DYNAMIC); // not to be flattened into the lines
    about->addChild(_lines);
    addChild(about);
    LatticeDragger::place();
}

LatticeDragger::~LatticeDragger() = default;

void LatticeDragger::place()
{
    if (_shown && *_shown == _lattice->getModifiedCount()) return;
    const double radius = ballRadius(*_lattice);
    for (unsigned i = 0; i < getNumDraggers(); ++i)
        getDragger(i)->setMatrix(handleShapes::ballPlace(_lattice->getPoint(i), radius));
    handleShapes::setLines(*_lines, linesOf(*_lattice, _lattice->getRestPoint(0)));
    _shown = _lattice->getModifiedCount();
}

ReportedStatus LatticeDragger::move(unsigned dragger)
{
    _shown.reset();
    const ReportedStatus status =
        _lattice->setPoint(dragger, getDragger(dragger)->getMatrix().getTrans());
    if (status) place();
    return status;
}

DragHistory::Restore LatticeDragger::remember()
{
    return [lattice = _lattice, kept = _lattice->getPoints()] { lattice->setPoints(kept); };
}

} // namespace osgVolumizer
