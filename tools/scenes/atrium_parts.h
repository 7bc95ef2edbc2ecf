// The pieces of the atrium: architecture and furniture as meshes, texture coordinates in metres.
#pragma once
#include "tools/scenes/shapes.h"

/// Base, fluted shaft and capital of the lower arcade, `height` tall, standing on y = 0.
Mesh lowerColumn(float height);

/// The slender round column of the gallery.
Mesh upperColumn(float height);

/// A turned baluster, 0.72 m tall.
Mesh baluster();

/// A hanging cloth with folds: x in +-width/2, from y = 0 down to y = -drop; `phase` varies the folds.
Mesh banner(float width, float drop, float fold, float phase);

Mesh pedestal(float height);

/// A slim-necked vase as a solid of revolution.
Mesh urn();

/// A drinking glass with thick walls, closed: outer wall, rim, inner wall.
Mesh goblet();

/// Frame of a hanging lantern of 0.5 m around the origin (the lamp goes there) and the rod from which it hangs.
Mesh lanternFrame(float rod);

/// A rectangular frame around x in +-width/2, y in 0..height, `bar` wide and `depth` deep, centred on z = 0.
Mesh frame(float width, float height, float bar, float depth);

/// The stone of a round basin of `radius` without its water, standing on y = 0; the water belongs at 0.42 m.
Mesh basin(float radius);
