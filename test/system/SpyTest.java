import java.awt.Component;
import java.awt.Container;
import java.awt.Point;
import java.awt.Rectangle;
import java.awt.Robot;
import java.awt.Toolkit;
import java.awt.Window;
import java.awt.event.InputEvent;
import java.awt.image.BufferedImage;
import java.io.File;
import java.util.concurrent.Callable;
import javax.imageio.ImageIO;
import javax.swing.JFrame;
import javax.swing.JMenuItem;
import javax.swing.JTable;

/**
 * Works lcm-spy as a person does, by mouse, on a real display: the channels are in the table with their
 * types and rates, a right click offers the plugin's views, and these draw the board.
 *
 * <p>Argument: where the screenshots go.
 */
public class SpyTest {
  private static final int PATIENCE_MS = 60_000;
  private static final String[][] CHANNELS = {
    {"LIDAR_POINTS", "pointcloud2_t"},
    {"CAMERA_IMAGE", "image_t"},
    {"CAMERA_INFO", "camera_info_t"},
    {"LIDAR_BOARD", "lidar_board_t"},
    {"CAMERA_BOARD", "camera_board_t"},
    {"MODULE_STATUS", "module_status_t"},
  };

  private static Robot robot;
  private static File folder;

  public static void main(String[] args) throws Exception {
    folder = new File(args[0]);
    robot = new Robot();
    robot.setAutoDelay(50);
    new Thread(() -> lcm.spy.Spy.main(new String[0])).start();
    JTable table = await("lcm-spy's table", () -> find(JTable.class));
    for (String[] channel : CHANNELS) {
      await(channel[0] + " with its type and rate", () -> isListed(table, channel) ? table : null);
    }
    screenshot("channels");
    openView(table, "CAMERA_IMAGE");
    openView(table, "LIDAR_POINTS");
    System.out.println("PASSED");
    System.exit(0);
  }

  /** Right click on the channel, click on the view, wait until it draws in many colours. */
  private static void openView(JTable table, String channel) throws Exception {
    Window spy = javax.swing.SwingUtilities.getWindowAncestor(table);
    spy.toFront();
    Rectangle cell = table.getCellRect(rowOf(table, channel), 0, true);
    Point at = table.getLocationOnScreen();
    click(at.x + cell.x + 20, at.y + cell.y + cell.height / 2, InputEvent.BUTTON3_DOWN_MASK);
    JMenuItem item = await("the view in the menu", () -> findItem("Show with board"));
    Point itemAt = item.getLocationOnScreen();
    click(itemAt.x + 10, itemAt.y + item.getHeight() / 2, InputEvent.BUTTON1_DOWN_MASK);
    JFrame frame = await("the window of " + channel, () -> findFrame(channel));
    frame.setLocation(100, 200);
    frame.toFront();
    // The views' drawings of a found board are pure green (outline) or of the full colour circle
    // (corners); nothing else in these scenes is.
    await("a board in " + channel, () -> numVividGreen(frame) > 20 ? frame : null);
    screenshot(channel.toLowerCase());
    frame.dispose();
  }

  private static boolean isListed(JTable table, String[] channel) {
    int row = rowOf(table, channel[0]);
    return row >= 0
        && String.valueOf(table.getValueAt(row, 1)).endsWith(channel[1])
        && Double.parseDouble(String.valueOf(table.getValueAt(row, 3)).trim()) > 0;
  }

  private static int rowOf(JTable table, String channel) {
    for (int row = 0; row < table.getRowCount(); ++row) {
      if (channel.equals(String.valueOf(table.getValueAt(row, 0)).trim())) {
        return row;
      }
    }
    return -1;
  }

  private static int numVividGreen(JFrame frame) {
    BufferedImage image = robot.createScreenCapture(frame.getBounds());
    int count = 0;
    for (int y = 0; y < image.getHeight(); ++y) {
      for (int x = 0; x < image.getWidth(); ++x) {
        int pixel = image.getRGB(x, y);
        int red = pixel >> 16 & 0xff;
        int green = pixel >> 8 & 0xff;
        int blue = pixel & 0xff;
        count += green > 230 && red < 60 && blue < 60 ? 1 : 0;
      }
    }
    return count;
  }

  private static void click(int x, int y, int button) {
    robot.mouseMove(x, y);
    robot.mousePress(button);
    robot.mouseRelease(button);
  }

  private static void screenshot(String name) throws Exception {
    Rectangle screen = new Rectangle(Toolkit.getDefaultToolkit().getScreenSize());
    ImageIO.write(robot.createScreenCapture(screen), "png", new File(folder, name + ".png"));
  }

  private static <T> T await(String what, Callable<T> answer) throws Exception {
    for (int waited = 0; waited < PATIENCE_MS; waited += 100) {
      T found = answer.call();
      if (found != null) {
        return found;
      }
      Thread.sleep(100);
    }
    screenshot("failed");
    System.err.println("FAILED: not seen: " + what);
    System.exit(1);
    return null;
  }

  private static JFrame findFrame(String title) {
    for (Window window : Window.getWindows()) {
      if (window instanceof JFrame && window.isShowing() && title.equals(((JFrame) window).getTitle())) {
        return (JFrame) window;
      }
    }
    return null;
  }

  private static JMenuItem findItem(String text) {
    JMenuItem item = find(JMenuItem.class, text);
    return item != null && item.isShowing() ? item : null;
  }

  private static <T extends Component> T find(Class<T> type) {
    return find(type, null);
  }

  private static <T extends Component> T find(Class<T> type, String text) {
    for (Window window : Window.getWindows()) {
      T found = find(window, type, text);
      if (found != null) {
        return found;
      }
    }
    return null;
  }

  private static <T extends Component> T find(Container container, Class<T> type, String text) {
    for (Component child : container.getComponents()) {
      if (type.isInstance(child) && (text == null || text.equals(((JMenuItem) child).getText()))) {
        return type.cast(child);
      }
      if (child instanceof Container) {
        T found = find((Container) child, type, text);
        if (found != null) {
          return found;
        }
      }
    }
    return null;
  }
}
