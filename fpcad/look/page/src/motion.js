// What a hand does from a pose, as frames to step through: its stored path, or the pose alone.

/** The paths of a row of which every state is there, one a pose. */
export function exactPaths({ opening, exact }, row) {
  return [...(opening?.exact ?? []), ...exact].filter((path) => path.row === row);
}

/** Whether a row can be shown: the chosen hand at once, every other one when the page is read. */
export function canShow(run, row) {
  return run.isWhole || (row === run.chosen && exactPaths(run, row).length === run.poses.length);
}

/** Frames of one hand's pose: {count, kind, position, rotation, at(frame)}. */
export function motionOf(run, row, poseIndex) {
  const pose = run.poses[poseIndex];
  const exact = exactPaths(run, row).find((path) => path.pose === pose.name);
  if (exact) return exactMotion(exact, pose);
  const kept = run.thin.rows.indexOf(row);
  return kept >= 0 ? thinMotion(run, kept, row, pose) : poseOnly(row, pose);
}

function exactMotion(path, pose) {
  const [nu, n] = [path.joints.shape[1], pose.contacts.length];
  return {
    kind: "path",
    count: path.turn.length,
    start: nearestToZero(path.turn),
    position: path.position,
    rotation: path.rotation,
    at: (i) => ({
      turn: path.turn[i],
      joints: slice(path.joints, i, nu),
      axial: slice(path.axial, i, n),
      angle: slice(path.angle, i, n),
      forces: slice(path.forces, i, 3 * n),
    }),
  };
}

const BETWEEN = 8; // frames from one keyframe to the next

function thinMotion(run, kept, row, pose) {
  const frames = run.thin.poses[pose.name];
  const keys = run.thin.keyframes;
  const read = (array, frame) => {
    const [, width] = array.shape;
    const key = Math.min(Math.floor(frame / BETWEEN), keys - 2), share = frame / BETWEEN - key;
    return Float32Array.from({ length: width }, (_, i) => {
      const at = (kept * width + i) * keys + key;
      return (1 - share) * array[at] + share * array[at + 1];
    });
  };
  const turns = Array.from({ length: keys }, (_, k) => frames.turn[kept * keys + k]);
  const only = poseOnly(row, pose);
  const start = nearestToZero(turns) * BETWEEN;
  return {
    kind: "keyframes",
    count: (keys - 1) * BETWEEN + 1,
    start,
    position: only.position,
    rotation: only.rotation,
    at: (i) => ({
      turn: read(frames.turn, i)[0],
      joints: read(frames.joints, i),
      axial: read(frames.axial, i),
      angle: read(frames.angle, i),
      forces: i === start ? only.at(0).forces : null,
    }),
  };
}

function poseOnly(row, pose) {
  const [nu, n] = [pose.joints.shape[1], pose.contacts.length];
  return {
    kind: "pose",
    count: 1,
    start: 0,
    position: slice(pose.position, row, 3),
    rotation: slice(pose.rotation, row, 3),
    at: () => ({
      turn: 0,
      joints: slice(pose.joints, row, nu),
      axial: slice(pose.axial, row, n),
      angle: slice(pose.angle, row, n),
      forces: slice(pose.forces, row, 3 * n),
    }),
  };
}

function slice(array, index, width) {
  return array.subarray(index * width, (index + 1) * width);
}

function nearestToZero(values) {
  let best = 0;
  values.forEach((value, i) => (best = Math.abs(value) < Math.abs(values[best]) ? i : best));
  return best;
}
