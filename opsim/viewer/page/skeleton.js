// A skeleton as emulator/skeleton.py has it: every joint but the root ends one bone, in joint order.

/** {names, parents, root, bones: child joint of each bone, chain: [bone, parent, child] from the root outwards}. */
export function skeletonOf({ names, parents }) {
  const bones = parents.map((parent, joint) => joint).filter((joint) => parents[joint] >= 0);
  const depth = (joint) => (parents[joint] < 0 ? 0 : 1 + depth(parents[joint]));
  const chain = bones.map((joint, bone) => [bone, parents[joint], joint]);
  chain.sort((a, b) => depth(a[2]) - depth(b[2])); // a stable sort, as Python's
  return { names, parents, root: parents.indexOf(-1), bones, chain };
}

/** Joints (3J), written into `joints`, below a root at (x, y, z) with this heading; directions (3B), lengths (B). */
export function stand(skeleton, directions, lengths, x, y, z, heading, joints) {
  const c = Math.cos(heading),
    s = Math.sin(heading),
    root = 3 * skeleton.root;
  joints[root] = x;
  joints[root + 1] = y;
  joints[root + 2] = z;
  for (const [bone, parent, child] of skeleton.chain) {
    const dx = directions[3 * bone],
      dy = directions[3 * bone + 1],
      length = lengths[bone];
    joints[3 * child] = joints[3 * parent] + length * (c * dx - s * dy);
    joints[3 * child + 1] = joints[3 * parent + 1] + length * (s * dx + c * dy);
    joints[3 * child + 2] = joints[3 * parent + 2] + length * directions[3 * bone + 2];
  }
}
