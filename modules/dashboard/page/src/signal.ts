// Tells who holds the board, and looks elsewhere, that a sample was taken.

const TONE_HZ = 880;
const TONE_S = 0.15;
let audio: AudioContext | null = null;

// A browser lets a page sound only once it was touched.
addEventListener("pointerdown", () => (audio ??= new AudioContext()), { once: true });

/** A short buzz of a phone, and a tone. */
export function signalTaken(): void {
  navigator.vibrate?.(120);
  if (!audio) return;
  const [tone, volume] = [audio.createOscillator(), audio.createGain()];
  tone.frequency.value = TONE_HZ;
  volume.gain.value = 0.15;
  tone.connect(volume).connect(audio.destination);
  tone.start();
  tone.stop(audio.currentTime + TONE_S);
}
