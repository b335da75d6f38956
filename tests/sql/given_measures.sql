-- SPDX-License-Identifier: GPL-3.0-or-later
-- Volumes by level of detail, and areas at level 2.2, beside those that the publisher states: how many there are, and how
-- many are equal within 0.1 %.
WITH solids AS (
  SELECT feature, lod, sum(wt_volume(shape)) AS volume FROM town GROUP BY feature, lod HAVING bool_and(shape IS NOT NULL)
), areas AS (
  SELECT feature, sum(area) FILTER (WHERE tilt > 179) AS ground, sum(area) FILTER (WHERE tilt BETWEEN 89 AND 91) AS walls
  FROM solids JOIN town USING (feature, lod), LATERAL wt_faces(shape) WHERE lod = '2.2' GROUP BY feature
), measures AS (
  SELECT 'volume' AS measure, volume AS here, value AS there
  FROM solids JOIN given USING (feature) WHERE name = 'b3_volume_lod' || replace(lod, '.', '')
  UNION ALL
  SELECT 'ground', ground, value FROM areas JOIN given USING (feature) WHERE name = 'b3_opp_grond'
  UNION ALL
  SELECT 'walls', walls, outer_walls.value + party_walls.value
  FROM areas JOIN given AS outer_walls USING (feature) JOIN given AS party_walls USING (feature)
  WHERE outer_walls.name = 'b3_opp_buitenmuur' AND party_walls.name = 'b3_opp_scheidingsmuur'
)
SELECT measure, count(*), count(*) FILTER (WHERE abs(here - there) <= 0.001 * there) FROM measures GROUP BY measure ORDER BY measure;
