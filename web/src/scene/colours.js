// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of what is shown; they can be told apart with most colour deficiencies and on light and
// dark pages.

/// Colours of semantic surfaces; null is a facet without.
export const kSurfaceColours = new Map([
  ['RoofSurface', '#b5533c'], ['WallSurface', '#d9cdb4'], ['GroundSurface', '#8d9a73'],
  ['ClosureSurface', '#b59ad6'], ['Window', '#5b9bd5'], ['Door', '#8a5a2b'],
  ['OuterCeilingSurface', '#c98f6d'], ['OuterFloorSurface', '#a7a08c'], ['WaterSurface', '#4f93c9'],
  ['TrafficArea', '#8f8f95'], ['AuxiliaryTrafficArea', '#a9b18f']
]);
export const kNoSurfaceColour = '#c3ccd6';
export const kFacetColour = '#e5243b';  // the facet of a finding
export const kOtherColour = '#f59a23';  // the other facet of a pair
export const kPlaceColour = '#9b30ff';  // the place of a finding
export const kUnprovenColour = '#d62f45';
export const kChosenColour = '#ffd23f';

export const kSteinerColour = '#e5243b';
export const kMissingColour = '#1f5fd0';  // of faces that the Delaunay tetrahedralization lacks
export const kTetrahedronColours = ['#8fb8de', '#f2c879', '#a8cf8e', '#d8a3c8', '#c9c2a5'];

export const surfaceColour = (type) => kSurfaceColours.get(type) ?? kNoSurfaceColour;
