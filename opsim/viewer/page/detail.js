// How large things are in the picture: who is not seen is not drawn, who is small is drawn with fewer corners.
import { Frustum, Matrix4, Sphere, Vector3 } from "three";

const REACH_M = 1.3; // of a person, with his shadow, about the pelvis

/** (x, y, z) => pixels that a metre measures there, 0 where a person would be outside the picture. */
export function sizesIn(camera, height) {
  camera.updateMatrixWorld();
  const seen = new Frustum().setFromProjectionMatrix(
    new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse),
  );
  const about = new Sphere(new Vector3(), REACH_M),
    scale = (camera.projectionMatrix.elements[5] * height) / 2;
  return (x, y, z) => {
    about.center.set(x, y, z);
    return seen.intersectsSphere(about) ? scale / about.center.distanceTo(camera.position) : 0;
  };
}
