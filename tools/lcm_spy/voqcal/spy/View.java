package voqcal.spy;

import java.awt.event.HierarchyEvent;
import java.io.IOException;
import javax.swing.JPanel;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;

/**
 * Draws the messages of one channel, and what a board detector says of the same capture time, for as
 * long as it is on the screen. Board messages are known by their type, on whatever channel they come.
 */
abstract class View extends JPanel implements LCMSubscriber {
  private static final String ALL_CHANNELS = ".*";

  private final String channel;
  private final long boardFingerprint;

  View(String channel, long boardFingerprint) {
    this.channel = channel;
    this.boardFingerprint = boardFingerprint;
    addHierarchyListener(
        event -> {
          if ((event.getChangeFlags() & HierarchyEvent.SHOWING_CHANGED) != 0) {
            listenWhileShowing();
          }
        });
  }

  /** Takes a sensor's message; called by LCM's thread. */
  abstract void takeSensorMessage(LCMDataInputStream message) throws IOException;

  /** Takes a board detector's message; called by LCM's thread. */
  abstract void takeBoardMessage(LCMDataInputStream message) throws IOException;

  private void listenWhileShowing() {
    if (isShowing()) {
      LCM.getSingleton().subscribe(ALL_CHANNELS, this);
    } else {
      LCM.getSingleton().unsubscribe(ALL_CHANNELS, this);
    }
  }

  @Override
  public void messageReceived(LCM lcm, String from, LCMDataInputStream message) {
    try {
      if (from.equals(channel)) {
        takeSensorMessage(message);
      } else if (message.available() >= Long.BYTES && message.readLong() == boardFingerprint) {
        message.reset();
        takeBoardMessage(message);
      } else {
        return;
      }
    } catch (IOException | RuntimeException error) {
      System.err.println(from + ": cannot be drawn: " + error);
      return;
    }
    repaint();
  }
}
